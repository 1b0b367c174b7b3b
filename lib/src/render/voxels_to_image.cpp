#include "render/voxels_to_image.h"

#include "render/depth_normals.h"
#include "render/picture.h"
#include "render/picture_request.h"
#include "render/solid_voxels.h"
#include "render/voxel_normals.h"

#include <bandvox/core/memory.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bandvox {

namespace {

using openvdb::Vec3d;

constexpr double kNowhere = std::numeric_limits<double>::infinity();

// Depths of an object's box, nearest and farthest.
struct DepthRange {
    double nearest = kNowhere, farthest = 0;

    DepthRange(const Camera& camera, const openvdb::BBoxd& box) {
        for (int i = 0; i < 8; ++i) {
            const double depth = camera.depth({i & 1 ? box.max()[0] : box.min()[0],
                                               i & 2 ? box.max()[1] : box.min()[1],
                                               i & 4 ? box.max()[2] : box.min()[2]});
            // What is behind the eye is not seen.
            nearest = std::min(nearest, std::max(depth, 0.0));
            farthest = std::max(farthest, depth);
        }
    }

    // 1 at the nearest, 0 at the farthest.
    double nearness(double depth) const {
        if (!(farthest > nearest)) return 1;
        return std::clamp((farthest - depth) / (farthest - nearest), 0.0, 1.0);
    }
};

// What is known of each pixel.
struct PixelSums {
    Vec3d light{0, 0, 0};
    int hits = 0;
};

class VoxelPicture {
  public:
    VoxelPicture(const VoxelScene& scene, const SolidVoxels& solid, Image& image)
        : mScene(scene),
          mShading(scene.options.shading),
          mSolid(solid),
          mToIndex(scene.grid.transform().baseMap()->getAffineMap()->getMat4().inverse()),
          mLighting(scene.options, scene.camera),
          mRange(scene.camera, worldBox(scene.grid)),
          mImage(image),
          mDistance(image.depth.size()),
          mNormal(mShading == Shading::Phong || mShading == Shading::Sobel3d ? image.depth.size()
                                                                             : 0),
          mSums(image.depth.size()) {}

    // Bytes per pixel while it is drawn.
    static constexpr double kBytesPerPixel = sizeof(double) + sizeof(Vec3d) + sizeof(PixelSums);

    // Follows the lines of sight through one place of each pixel, and adds up what they see.
    void addSamples(const openvdb::Vec2d& place, Progress& progress) {
        forEachTile(mImage.width, mImage.height, progress, [&](const PixelBox& tile) {
            const SolidVoxels::Probe probe = mSolid.probe();
            tile.forEach(progress, [&](int column, int row) { look(column, row, place, probe); });
        });
        const DistanceBuffer buffer{mImage.width, mImage.height, place, mDistance};
        const DepthNormals normals(
            mScene.camera, buffer,
            mShading == Shading::Cross ? DepthNormals::kCross : DepthNormals::kSobel);
        forEachTile(mImage.width, mImage.height, progress, [&](const PixelBox& tile) {
            tile.forEach(progress,
                         [&](int column, int row) { shade(column, row, place, normals); });
        });
    }

    // Sets the picture's colours. Returns how many lines of sight hit.
    std::int64_t finish() {
        std::int64_t hits = 0;
        for (std::size_t pixel = 0; pixel < mSums.size(); ++pixel) {
            setColor(mImage, pixel, mSums[pixel].light, mSums[pixel].hits, mScene.options);
            hits += mSums[pixel].hits;
        }
        return hits;
    }

  private:
    std::size_t pixelAt(int column, int row) const {
        return static_cast<std::size_t>(row) * mImage.width + column;
    }

    // Finds how far a pixel's line of sight goes, and the normal there if voxels give it.
    void look(int column, int row, const openvdb::Vec2d& place, const SolidVoxels::Probe& probe) {
        const std::size_t pixel = pixelAt(column, row);
        const Ray ray = mScene.camera.ray(column + place[0], row + place[1]);
        // Keep t: a length in world units, whatever the voxels' shape.
        const Ray indexRay{mToIndex.transform(ray.origin), mToIndex.transform3x3(ray.direction)};
        const auto hit = mSolid.firstHit(indexRay, probe);
        mDistance[pixel] = hit ? hit->t : kNowhere;
        if (!hit || mNormal.empty()) return;
        if (hit->axis < 0) {
            mNormal[pixel] = -ray.direction;  // the eye is inside: the surface faces it
            return;
        }
        const Vec3d normal =
            mShading == Shading::Phong
                ? phongNormal(*hit, indexRay.origin + hit->t * indexRay.direction, probe)
                : sobelNormal(*hit, probe);
        mNormal[pixel] = mScene.grid.transform().baseMap()->applyIJT(normal).unit();
    }

    // Adds what a pixel's line of sight sees.
    void shade(int column, int row, const openvdb::Vec2d& place, const DepthNormals& normals) {
        const std::size_t pixel = pixelAt(column, row);
        if (std::isinf(mDistance[pixel])) return;
        const Ray ray = mScene.camera.ray(column + place[0], row + place[1]);
        Sight sight;
        sight.position = ray.origin + mDistance[pixel] * ray.direction;
        sight.depth = mScene.camera.depth(sight.position);
        PixelSums& sums = mSums[pixel];
        if (mShading == Shading::Depth) {
            sight.normal = Vec3d(0.0);
            sums.light += mLighting.tone(mRange.nearness(sight.depth));
        } else {
            sight.normal = mNormal.empty() ? normals.at(column, row) : mNormal[pixel];
            sums.light += mLighting.shade(sight.normal);
        }
        ++sums.hits;
        if (sums.hits == 1 || static_cast<float>(sight.depth) < mImage.depth[pixel]) {
            setSight(mImage, pixel, sight);
        }
    }

    const VoxelScene& mScene;
    Shading mShading;
    const SolidVoxels& mSolid;
    openvdb::Mat4d mToIndex;
    Lighting mLighting;
    DepthRange mRange;
    Image& mImage;
    std::vector<double> mDistance;  // of the present samples
    std::vector<Vec3d> mNormal;     // the same; empty if it comes from the distances, or not at all
    std::vector<PixelSums> mSums;
};

}  // namespace

RenderResult voxelsToImage(const VoxelScene& scene, Progress& progress) {
    const RenderOptions& options = scene.options;
    const SolidVoxels solid(scene.grid, scene.iso, progress);
    if (solid.empty()) {
        if (options.allowEmpty) return emptyPicture(options);
        failEmpty(solid.maximum(), scene.iso);
    }

    RenderResult result;
    result.image = blankImage(options);
    describe(result.image, scene.grid, scene.iso);
    describe(result.image, options, scene.camera);
    requireMemory(VoxelPicture::kBytesPerPixel * static_cast<double>(result.image.depth.size()),
                  "the picture");
    VoxelPicture picture(scene, solid, result.image);
    {
        const ProgressStage stage(progress, "drawing",
                                  2 * options.samples * tileCount(options.width, options.height));
        for (const openvdb::Vec2d& place : samplePlaces(options.samples)) {
            picture.addSamples(place, progress);
        }
    }
    result.hits = picture.finish();
    result.rays = std::int64_t(options.width) * options.height * options.samples;
    if (!options.allowEmpty) requireHits(result, solid.maximum(), scene.iso);
    return result;
}

}  // namespace bandvox

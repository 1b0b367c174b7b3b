#include "render/picture.h"
#include "render/picture_request.h"
#include "render/ray_march.h"
#include "render/surface_blocks.h"
#include "render/surface_field.h"
#include "render/voxels_to_image.h"

#include <bandvox/core/error.h>
#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/render/density_to_image.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

namespace bandvox {

namespace {

// Gradients below this part of a flat face's have no direction worth showing.
constexpr double kFlatGradient = 1e-4;

// Everything that drawing a pixel needs, the same for all threads.
class Scene {
  public:
    Scene(const openvdb::FloatGrid& grid, const RenderOptions& options, const Camera& camera,
          const RayMarch& march, double faceGradient)
        : mTransform(grid.transform()),
          mToIndex(grid.transform().baseMap()->getAffineMap()->getMat4().inverse()),
          mOptions(options),
          mCamera(camera),
          mMarch(march),
          mFlat(kFlatGradient * faceGradient),
          mPlaces(samplePlaces(options.samples)),
          mLighting(options, camera) {}

    // Draws one pixel. Returns how many of its lines of sight hit.
    int draw(int column, int row, DensityProbe& density, Image& image) const {
        const std::size_t pixel = static_cast<std::size_t>(row) * image.width + column;
        std::optional<Sight> nearest;
        openvdb::Vec3d light(0.0);
        int hits = 0;
        for (const openvdb::Vec2d& place : mPlaces) {
            const auto sight = look(mCamera.ray(column + place[0], row + place[1]), density);
            if (!sight) continue;
            ++hits;
            light += mLighting.shade(sight->normal);
            if (!nearest || sight->depth < nearest->depth) nearest = sight;
        }
        setColor(image, pixel, light, hits, mOptions);
        if (nearest) setSight(image, pixel, *nearest);
        return hits;
    }

  private:
    std::optional<Sight> look(const Ray& ray, DensityProbe& density) const {
        // Keep t: a length in world units, whatever the voxels' shape.
        const Ray indexRay{mToIndex.transform(ray.origin), mToIndex.transform3x3(ray.direction)};
        const auto hit = mMarch.firstHit(indexRay, density);
        if (!hit) return std::nullopt;
        const openvdb::Vec3d position = ray.origin + hit->t * ray.direction;
        // Deep inside, where an eye may start, there is no slope: the surface faces the eye.
        openvdb::Vec3d normal = -ray.direction;
        if (hit->gradient.length() > mFlat) {
            normal = -mTransform.baseMap()->applyIJT(hit->gradient).unit();
        }
        return Sight{mCamera.depth(position), position, normal};
    }

    const openvdb::math::Transform& mTransform;
    openvdb::Mat4d mToIndex;
    const RenderOptions& mOptions;
    const Camera& mCamera;
    const RayMarch& mMarch;
    double mFlat;
    std::vector<openvdb::Vec2d> mPlaces;
    Lighting mLighting;
};

// Draws all pixels. Returns how many lines of sight hit.
std::int64_t drawTiles(const Scene& scene, const Reconstruction& reconstruction, Image& image,
                       Progress& progress) {
    const ProgressStage stage(progress, "drawing", tileCount(image.width, image.height));
    std::atomic<std::int64_t> hits{0};
    forEachTile(image.width, image.height, progress, [&](const PixelBox& tile) {
        const auto density = reconstruction.probe();
        std::int64_t tileHits = 0;
        tile.forEach(progress, [&](int column, int row) {
            tileHits += scene.draw(column, row, *density, image);
        });
        hits += tileHits;
    });
    return hits;
}

}  // namespace

RenderResult densityToImage(const openvdb::FloatGrid::ConstPtr& grid, const RenderOptions& options,
                            Progress& progress) {
    // Refuse what cannot be drawn.
    requireValid(options);
    if (!grid) throw Error(ErrorKind::Input, "a picture needs a density grid, but got none");
    if (options.allowEmpty && grid->evalActiveVoxelBoundingBox().empty()) {
        return emptyPicture(options, options.iso.value_or(0.5), *grid);
    }
    const DrawableGrid drawable = makeDrawable(grid, options);
    const openvdb::FloatGrid& field = *drawable.grid;
    const double iso = drawable.iso;
    worldBox(field);  // refuses what is not finite
    const Camera camera(options.camera, options.width, options.height, activePoints(field));
    if (options.shading != Shading::Spectral) {
        return voxelsToImage({field, iso, camera, options}, progress);
    }

    // Find where the surface can be, and read the lattice there.
    const SurfaceBlocks blocks(field, surfaceThreshold(drawable));
    if (!blocks.finite()) failNotFinite(field);
    if (blocks.empty()) {
        if (options.allowEmpty) return emptyPicture(options, iso, *grid);
        failEmpty(blocks.maximum(), iso);
    }
    const SurfaceField surface = readSurface(drawable, blocks.maximum());
    const RayMarch march(blocks, iso, surface.clear);

    // Draw.
    RenderResult result;
    result.image = blankImage(options, drawable.isLevelSet ? -iso : iso, *grid);
    const Scene scene(field, options, camera, march, surface.slope);
    result.hits = drawTiles(scene, *surface.reconstruction, result.image, progress);
    result.rays = std::int64_t(options.width) * options.height * options.samples;
    if (!options.allowEmpty) requireHits(result, blocks.maximum(), iso);
    return result;
}

}  // namespace bandvox

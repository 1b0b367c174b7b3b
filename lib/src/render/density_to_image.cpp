#include "reconstruct/interpolation_design.h"
#include "render/picture.h"
#include "render/picture_request.h"
#include "render/ray_march.h"
#include "render/surface_blocks.h"
#include "render/voxels_to_image.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/render/density_to_image.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace bandvox {

namespace {

// The eye cannot tell a finer reconstruction; a coarser one is no picture of the density.
constexpr double kFinestTolerance = 1e-4;
constexpr double kCoarsestTolerance = 0.1;

// Of solids under a filter that does not ring a flat face is the steepest; others come close.
constexpr double kSteepestMargin = 1.5;

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

// What the density of a grid of this library may be off by.
double densityError(const DensityMetadata& metadata) {
    constexpr double kOfSampling = 0.05;  // where it was not measured
    const double ofSampling =
        std::isnan(metadata.samplingError) ? kOfSampling : metadata.samplingError;
    return std::max(ClearDistance::kDensityError,
                    metadata.tolerance + ofSampling + metadata.storageError);
}

// How far lines of sight may step. Solids under the default filter have a sharp bound; others,
// and what was not made by this library, are taken to be about as steep as a flat face.
ClearDistance clearDistance(const openvdb::FloatGrid& grid,
                            const std::optional<DensityMetadata>& metadata, double maximum,
                            double iso, double faceSlope) {
    constexpr double kRounding = 1e-2;
    const double background = grid.background();
    const double error = metadata ? densityError(*metadata) : ClearDistance::kDensityError;
    // Overlapping shells that were limited to 1 are no solid's density.
    if (metadata && metadata->order == 2 && !metadata->clamped && background == 0 &&
        maximum < 1 + kRounding && iso < 1) {
        return ClearDistance::ofGaussian(iso, metadata->cutoff, error);
    }
    const double range = std::max(1.0, maximum - background);
    return ClearDistance::ofSlope(iso, background, kSteepestMargin * faceSlope * range, error);
}

// Memory for the reconstruction's bricks: what most pictures need, if the machine has it.
std::size_t cacheBytes() {
    constexpr std::int64_t kLeast = std::int64_t(64) << 20, kMost = std::int64_t(2) << 30;
    return static_cast<std::size_t>(std::clamp(availableMemory() / 4, kLeast, kMost));
}

// Sharp filters keep more than can be read between the nodes to the finest tolerance: then read
// them as well as can be.
std::unique_ptr<Reconstruction> readLattice(const openvdb::FloatGrid::ConstPtr& grid,
                                            const ExponentialFilter& filter, double tolerance) {
    BrickReconstructionOptions options{filter, tolerance, cacheBytes()};
    for (;; options.tolerance *= 3) {
        try {
            options.tolerance = std::min(options.tolerance, kCoarsestTolerance);
            return makeBrickReconstruction(grid, options);
        } catch (const Error& error) {
            if (options.tolerance < kCoarsestTolerance) continue;
            throw Error(ErrorKind::Input,
                        "the grid \"" + grid->getName() + "\" cannot be read: " + error.what());
        }
    }
}

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
    requireDensity(*grid);
    const std::optional<DensityMetadata> metadata = densityMetadata(*grid);
    const double iso = isoOf(*grid, metadata, options);
    const Camera camera(options.camera, options.width, options.height, worldBox(*grid));
    if (options.shading != Shading::Spectral) {
        return voxelsToImage({*grid, iso, camera, options}, progress);
    }

    // Read the lattice by the filter that it was made with.
    const auto filter =
        metadata ? ExponentialFilter{metadata->order, metadata->cutoff} : ExponentialFilter();
    const auto reconstruction =
        readLattice(grid, filter, std::max(metadata ? metadata->tolerance : 0, kFinestTolerance));

    // Find where the surface can be. Between the nodes of the lattice the density can rise above
    // them: a Gaussian's by no more than its slope times half a voxel's diagonal, 0.24, and others
    // not much further; half the height is on the safe side.
    const double slope = faceGradient(filter);
    const SurfaceBlocks blocks(*grid, 0.5 * (iso + grid->background()));
    if (!blocks.finite()) failNotFinite(*grid);
    if (blocks.empty()) failEmpty(blocks.maximum(), iso);
    const RayMarch march(blocks, iso, clearDistance(*grid, metadata, blocks.maximum(), iso, slope));

    // Draw.
    RenderResult result;
    result.image = blankImage(options, iso, *grid);
    const Scene scene(*grid, options, camera, march, slope);
    result.hits = drawTiles(scene, *reconstruction, result.image, progress);
    result.rays = std::int64_t(options.width) * options.height * options.samples;
    requireHits(result, blocks.maximum(), iso);
    return result;
}

}  // namespace bandvox

#include "reconstruct/interpolation_design.h"
#include "render/ray_march.h"
#include "render/surface_blocks.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/render/density_to_image.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

constexpr int kLargestSide = 65536;
constexpr int kMostSamples = 4096;

// Pixels along the side of what one task draws.
constexpr int kImageTile = 32;

// The eye cannot tell a finer reconstruction; a coarser one is no picture of the density.
constexpr double kFinestTolerance = 1e-4;
constexpr double kCoarsestTolerance = 0.1;

// Of solids under a filter that does not ring a flat face is the steepest; others come close.
constexpr double kSteepestMargin = 1.5;

// Gradients below this part of a flat face's have no direction worth showing.
constexpr double kFlatGradient = 1e-4;

template <typename Value>
void requireInRange(const char* what, Value found, Value lowest, Value highest) {
    if (found >= lowest && found <= highest) return;
    std::ostringstream message;
    message << "the picture's " << what << " is " << found << "; it must be " << lowest << " to "
            << highest;
    throw Error(ErrorKind::Usage, message.str());
}

void requireColor(const char* what, const openvdb::Vec3d& color) {
    for (int c = 0; c < 3; ++c) requireInRange(what, color[c], 0.0, 1e6);
}

[[noreturn]] void failNotFinite(const openvdb::FloatGrid& grid) {
    throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                      "\" has values that are not finite; expected a density");
}

// Throws unless `grid` is a density that can be drawn.
void requireDensity(const openvdb::FloatGrid& grid) {
    const std::string name = "the grid \"" + grid.getName() + "\" ";
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw Error(ErrorKind::Input,
                    name +
                        "is a level set (signed distances); expected a density: convert it "
                        "first, with `bandvox convert` or OpenVDB's sdfToFogVolume");
    }
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Input, name + "has a transform of type " +
                                          grid.transform().mapType() +
                                          ", which bends lines of sight; expected a linear one");
    }
    if (grid.evalActiveVoxelBoundingBox().empty()) {
        throw Error(ErrorKind::Input, name + "has no active voxel; expected a density");
    }
    if (!std::isfinite(grid.background())) failNotFinite(grid);
}

double isoOf(const openvdb::FloatGrid& grid, const std::optional<DensityMetadata>& metadata,
             const RenderOptions& options) {
    const double iso = options.iso.value_or(metadata ? metadata->iso : 0.5);
    if (!std::isfinite(iso) || !(iso > grid.background())) {
        std::ostringstream message;
        message << "the iso-value "
                << (options.iso ? ""
                    : metadata  ? "stored in the grid "
                                : "")
                << "is " << iso << "; it must be above the grid's background, "
                << grid.background();
        throw Error(options.iso ? ErrorKind::Usage : ErrorKind::Input, message.str());
    }
    return iso;
}

// The box of the active voxels, world units.
openvdb::BBoxd worldBox(const openvdb::FloatGrid& grid) {
    const openvdb::CoordBBox voxels = grid.evalActiveVoxelBoundingBox();
    const openvdb::BBoxd index(voxels.min().asVec3d() - openvdb::Vec3d(0.5),
                               voxels.max().asVec3d() + openvdb::Vec3d(0.5));
    openvdb::BBoxd world;
    for (int i = 0; i < 8; ++i) {
        world.expand(grid.indexToWorld(openvdb::Vec3d(i & 1 ? index.max()[0] : index.min()[0],
                                                      i & 2 ? index.max()[1] : index.min()[1],
                                                      i & 4 ? index.max()[2] : index.min()[2])));
    }
    if (!std::isfinite(world.extents().length())) failNotFinite(grid);
    return world;
}

// Where in a pixel, [0, 1)², its lines of sight pass: rows of evenly spaced places.
std::vector<openvdb::Vec2d> samplePlaces(int samples) {
    const int rows = std::max(1, static_cast<int>(std::sqrt(samples + 0.5)));
    std::vector<openvdb::Vec2d> places;
    for (int row = 0; row < rows; ++row) {
        const int columns = samples / rows + (row < samples % rows ? 1 : 0);
        for (int column = 0; column < columns; ++column) {
            places.emplace_back((column + 0.5) / columns, (row + 0.5) / rows);
        }
    }
    return places;
}

// What a line of sight meets.
struct Sight {
    double depth;
    openvdb::Vec3d position, normal;  // world
};

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
          mPlaces(samplePlaces(options.samples)) {
        const openvdb::Vec3d& light = options.light;
        mLight =
            (light[0] * camera.right() + light[1] * camera.upward() - light[2] * camera.forward())
                .unit();
    }

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
            light += shade(*sight);
            if (!nearest || sight->depth < nearest->depth) nearest = sight;
        }
        const double coverage = double(hits) / mOptions.samples;
        light /= mOptions.samples;
        if (mOptions.background) light += (1 - coverage) * *mOptions.background;
        for (int c = 0; c < 3; ++c) image.color[4 * pixel + c] = static_cast<float>(light[c]);
        image.color[4 * pixel + 3] = mOptions.background ? 1.0F : static_cast<float>(coverage);
        if (nearest) {
            image.depth[pixel] = static_cast<float>(nearest->depth);
            for (int c = 0; c < 3; ++c) {
                image.normal[3 * pixel + c] = static_cast<float>(nearest->normal[c]);
                image.position[3 * pixel + c] = static_cast<float>(nearest->position[c]);
            }
        }
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

    openvdb::Vec3d shade(const Sight& sight) const {
        const double lambert = std::max(sight.normal.dot(mLight), 0.0);
        return mOptions.color * (mOptions.ambient + (1 - mOptions.ambient) * lambert);
    }

    const openvdb::math::Transform& mTransform;
    openvdb::Mat4d mToIndex;
    const RenderOptions& mOptions;
    const Camera& mCamera;
    const RayMarch& mMarch;
    double mFlat;
    std::vector<openvdb::Vec2d> mPlaces;
    openvdb::Vec3d mLight;
};

Image blankImage(const RenderOptions& options, double iso,
                 const std::optional<DensityMetadata>& metadata) {
    const std::size_t pixels = static_cast<std::size_t>(options.width) * options.height;
    requireMemory(11.0 * sizeof(float) * static_cast<double>(pixels), "the picture");
    Image image;
    image.width = options.width;
    image.height = options.height;
    image.color.assign(4 * pixels, 0.0F);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    image.normal.assign(3 * pixels, 0.0F);
    image.position.assign(3 * pixels, 0.0F);
    std::ostringstream isoText;
    isoText << iso;
    image.metadata = {{"Software", std::string("Bandvox ") + version()},
                      {"bandvox_iso", isoText.str()}};
    if (metadata && !metadata->source.empty()) {
        image.metadata.emplace_back("bandvox_source", metadata->source);
    }
    return image;
}

// How far lines of sight may step. Solids under the default filter have a sharp bound; others,
// and what was not made by this library, are taken to be about as steep as a flat face.
ClearDistance clearDistance(const openvdb::FloatGrid& grid,
                            const std::optional<DensityMetadata>& metadata, double maximum,
                            double iso, double faceSlope) {
    constexpr double kRounding = 1e-2;
    const double background = grid.background();
    if (metadata && metadata->order == 2 && background == 0 && maximum < 1 + kRounding && iso < 1) {
        return ClearDistance::ofGaussian(iso, metadata->cutoff);
    }
    const double range = std::max(1.0, maximum - background);
    return ClearDistance::ofSlope(iso, background, kSteepestMargin * faceSlope * range);
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

// No line of sight has met the surface: either it is not there, or it is elsewhere.
[[noreturn]] void failUnseen(std::int64_t rays, double maximum, double iso) {
    std::ostringstream message;
    message << "nothing to see: ";
    if (maximum < iso) {
        message << "the density reaches " << maximum << " only, below the iso-value " << iso;
    } else {
        message << "none of " << rays
                << " lines of sight meets the surface; expected the camera to face it";
    }
    throw Error(ErrorKind::Result, message.str());
}

// Draws all pixels, a tile to a task. Returns how many lines of sight hit.
std::int64_t drawTiles(const Scene& scene, const Reconstruction& reconstruction, Image& image,
                       Progress& progress) {
    const std::int64_t across = (image.width + kImageTile - 1) / kImageTile;
    const std::int64_t down = (image.height + kImageTile - 1) / kImageTile;
    const ProgressStage stage(progress, "drawing", across * down);
    std::atomic<std::int64_t> hits{0};
    parallelFor(across * down, [&](std::int64_t tile) {
        const auto density = reconstruction.probe();
        const int left = static_cast<int>(tile % across) * kImageTile;
        const int top = static_cast<int>(tile / across) * kImageTile;
        std::int64_t tileHits = 0;
        for (int row = top; row < std::min(top + kImageTile, image.height); ++row) {
            progress.throwIfInterrupted();
            for (int column = left; column < std::min(left + kImageTile, image.width); ++column) {
                tileHits += scene.draw(column, row, *density, image);
            }
        }
        hits += tileHits;
        progress.advance();
    });
    return hits;
}

}  // namespace

void requireValid(const RenderOptions& options) {
    requireInRange("width, pixels,", options.width, 1, kLargestSide);
    requireInRange("height, pixels,", options.height, 1, kLargestSide);
    requireInRange("number of samples per pixel", options.samples, 1, kMostSamples);
    requireInRange("ambient light", options.ambient, 0.0, 1.0);
    requireColor("color", options.color);
    if (options.background) requireColor("background", *options.background);
    requireValid(options.camera);
    const double light = options.light.length();
    if (!(light > 0) || !std::isfinite(light)) {
        std::ostringstream message;
        message << "the light comes from " << options.light << "; it must be a direction";
        throw Error(ErrorKind::Usage, message.str());
    }
}

RenderResult densityToImage(openvdb::FloatGrid::ConstPtr grid, const RenderOptions& options,
                            Progress& progress) {
    // Refuse what cannot be drawn.
    requireValid(options);
    if (!grid) throw Error(ErrorKind::Input, "a picture needs a density grid, but got none");
    requireDensity(*grid);
    const std::optional<DensityMetadata> metadata = densityMetadata(*grid);
    const double iso = isoOf(*grid, metadata, options);
    const Camera camera(options.camera, options.width, options.height, worldBox(*grid));

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
    if (blocks.empty()) {
        std::ostringstream message;
        message << "nothing to see: the density is at most " << blocks.maximum()
                << ", below the iso-value " << iso;
        throw Error(ErrorKind::Result, message.str());
    }
    const RayMarch march(blocks, iso, clearDistance(*grid, metadata, blocks.maximum(), iso, slope));

    // Draw.
    RenderResult result;
    result.image = blankImage(options, iso, metadata);
    const Scene scene(*grid, options, camera, march, slope);
    result.hits = drawTiles(scene, *reconstruction, result.image, progress);
    result.rays = std::int64_t(options.width) * options.height * options.samples;
    if (result.hits == 0) failUnseen(result.rays, blocks.maximum(), iso);
    return result;
}

}  // namespace bandvox

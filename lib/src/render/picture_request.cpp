#include "render/picture_request.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

constexpr int kLargestSide = 65536;
constexpr int kMostSamples = 4096;
constexpr int kMostBounces = 64;
constexpr int kMostObjects = 64;

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

using DensityLeaf = openvdb::FloatTree::LeafNodeType;
using Points = std::vector<openvdb::Vec3d>;

// Places this many voxels from a node have no part in its value where a grid is read by averages:
// half the width of a cubic B-spline.
constexpr double kAverageReach = 2;

// The corners, world units, of boxes that end `around` voxels beyond the centres of voxels: of a
// box of each leaf, boxOf(leaf), and of the tiles from `tile` on that have a part, takes(value).
template <typename BoxOf, typename Tile, typename Takes>
Points cornersOfNodes(const openvdb::FloatGrid& grid, double around, const Progress& progress,
                      const BoxOf& boxOf, Tile tile, const Takes& takes) {
    const auto add = [&](const openvdb::CoordBBox& voxels, Points& points) {
        if (voxels.empty()) return;
        for (int i = 0; i < 8; ++i) {
            openvdb::Vec3d corner;
            for (int axis = 0; axis < 3; ++axis) {
                corner[axis] = (i >> axis & 1) != 0 ? voxels.max()[axis] + around
                                                    : voxels.min()[axis] - around;
            }
            points.push_back(grid.indexToWorld(corner));
        }
    };
    std::vector<const DensityLeaf*> leaves;
    grid.tree().getNodes(leaves);
    constexpr std::size_t kTogether = 4096;
    std::vector<Points> parts((leaves.size() + kTogether - 1) / kTogether);
    parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto k = static_cast<std::size_t>(i);
        const std::size_t end = std::min((k + 1) * kTogether, leaves.size());
        parts[k].reserve(8 * (end - k * kTogether));
        for (std::size_t leaf = k * kTogether; leaf < end; ++leaf) {
            add(boxOf(*leaves[leaf]), parts[k]);
        }
    });
    Points points;
    points.reserve(8 * leaves.size());
    for (const Points& part : parts) points.insert(points.end(), part.begin(), part.end());
    tile.setMaxDepth(Tile::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (takes(*tile)) add(tile.getBoundingBox(), points);
    }
    return points;
}

// How far a density reaches that is read by averages, which count inactive voxels as well.
Points pointsOfAverages(const openvdb::FloatGrid& grid, const Progress& progress) {
    const auto boxOf = [](const DensityLeaf& leaf) {
        openvdb::CoordBBox box;
        const float* values = leaf.buffer().data();
        for (openvdb::Index i = 0; i < DensityLeaf::SIZE; ++i) {
            if (values[i] > 0) box.expand(leaf.origin() + DensityLeaf::offsetToLocalCoord(i));
        }
        return box;
    };
    return cornersOfNodes(grid, kAverageReach, progress, boxOf, grid.tree().cbeginValueAll(),
                          [](float value) { return value > 0; });
}

void append(Points& points, Points more) {
    if (points.empty()) {
        points = std::move(more);
    } else {
        points.insert(points.end(), more.begin(), more.end());
    }
}

}  // namespace

void failNotFinite(const openvdb::FloatGrid& grid) {
    throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                      "\" has values that are not finite; expected a density");
}

void failNamed(const SceneObject& object, const Error& error) {
    if (error.kind() == ErrorKind::Interrupted) throw;
    const std::string of = object.name.empty() ? "" : object.name + ": ";
    throw Error(error.kind(), of + error.what());
}

void requireValid(const PictureOptions& options) {
    requireInRange("width, pixels,", options.width, 1, kLargestSide);
    requireInRange("height, pixels,", options.height, 1, kLargestSide);
    requireInRange("number of samples per pixel", options.samples, 1, kMostSamples);
    requireInRange("tolerance of reading", options.tolerance, 1e-6, 0.1);
    requireInRange("number of directions to gather", options.transport.gather, 0, kMostSamples);
    requireInRange("number of bounces", options.transport.bounces, 0, kMostBounces);
    requireInRange("depth of mirrors and glass", options.transport.depth, 0, kMostBounces);
    requireInRange("step in volumes, voxels,", options.volumes.step, 0.05, 16.0);
    requireInRange("distance to gather, world units,", options.transport.gatherDistance, 0.0,
                   std::numeric_limits<double>::max());
    requireInRange("time between previews, seconds,", options.previewSeconds, 0.0, 1e9);
    if (options.transport.bounces > 0 && options.transport.gather == 0) {
        throw Error(ErrorKind::Usage,
                    "light bounces where it is gathered, and the number of directions to gather is "
                    "0; expected 1 or more");
    }
    if (options.background) requireColor("background", *options.background);
    if (options.crop) {
        const CropWindow& crop = *options.crop;
        if (!(crop.left >= 0 && crop.left < crop.right && crop.right <= options.width &&
              crop.top >= 0 && crop.top < crop.bottom && crop.bottom <= options.height)) {
            std::ostringstream message;
            message << "the crop window is columns " << crop.left << " to " << crop.right
                    << ", rows " << crop.top << " to " << crop.bottom
                    << "; expected a part of the picture's " << options.width << " x "
                    << options.height << " pixels";
            throw Error(ErrorKind::Usage, message.str());
        }
    }
    requireValid(options.camera);
}

void requireValid(const RenderOptions& options) {
    requireValid(static_cast<const PictureOptions&>(options));
    requireInRange("ambient light", options.ambient, 0.0, 1.0);
    requireColor("color", options.color);
    const double light = options.light.length();
    if (!(light > 0) || !std::isfinite(light)) {
        std::ostringstream message;
        message << "the light comes from " << options.light << "; it must be a direction";
        throw Error(ErrorKind::Usage, message.str());
    }
    if (options.shading != Shading::Spectral && options.crop) {
        throw Error(ErrorKind::Usage,
                    "a crop window goes with spectral shading only: the others look at pixels "
                    "beside each other");
    }
}

void requireValid(const Light& light) {
    requireColor("color of a light", light.color);
    const bool isPoint = light.kind == Light::Kind::Point;
    requireInRange(isPoint ? "radius of a light, world units," : "size of a light, degrees,",
                   light.size, 0.0, isPoint ? 1e30 : 180.0);
    const double length = light.place.length();
    if (!std::isfinite(length) || (!isPoint && !(length > 0))) {
        std::ostringstream message;
        message << "a light comes from " << light.place << "; it must be a "
                << (isPoint ? "place" : "direction");
        throw Error(ErrorKind::Usage, message.str());
    }
}

void requireValid(const Scene& scene) {
    const auto objects = static_cast<int>(scene.objects.size());
    if (objects < 1 || objects > kMostObjects) {
        throw Error(ErrorKind::Usage, "a scene of " + std::to_string(objects) +
                                          " objects; expected 1 to " +
                                          std::to_string(kMostObjects));
    }
    for (const SceneObject& object : scene.objects) {
        if (!object.grid) {
            throw Error(ErrorKind::Input, "a picture needs a density grid, but got none");
        }
        const Material& material = object.material;
        requireColor("color", material.color);
        requireInRange("roughness", material.roughness, 0.0, 1.0);
        requireInRange("reflectance", material.reflectance, 0.0, 1.0);
        requireInRange("transparency", material.transparency, 0.0, 1.0);
        requireInRange("refractive index", material.refractiveIndex, 1.0, 4.0);
        requireInRange("length of the tint, world units,", material.tintLength, 0.0, 1e30);
        const Medium& medium = object.medium;
        for (int c = 0; c < 3; ++c) {
            requireInRange("color of a volume", medium.color[c], 0.0, 1.0);
        }
        requireColor("emission of a volume", medium.emission);
        requireInRange("extinction of a volume, per world unit,", medium.extinction, 0.0, 1e30);
        requireInRange("anisotropy of a volume", medium.anisotropy, -0.999, 0.999);
        requireInRange("glow of a volume", medium.glow, 0.0, 1e30);
    }
    for (const Light& light : scene.lights) requireValid(light);
    requireColor("color of the environment", scene.environment.color);
}

double shortestVoxelSide(const openvdb::FloatGrid& grid) {
    const openvdb::Vec3d size = grid.voxelSize();
    return std::min({size[0], size[1], size[2]});
}

void requireDrawable(const openvdb::FloatGrid& grid) {
    const std::string name = "the grid \"" + grid.getName() + "\" ";
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Input, name + "has a transform of type " +
                                          grid.transform().mapType() +
                                          ", which bends lines of sight; expected a linear one");
    }
    if (!grid.cbeginValueOn()) {
        throw Error(ErrorKind::Input,
                    name + "has no active voxel; expected a density or a level set");
    }
    if (!std::isfinite(grid.background())) failNotFinite(grid);
}

bool isAboveBackground(double iso, float background) {
    return static_cast<float>(0.5 * (iso + background)) > background;
}

double isoOf(const openvdb::FloatGrid& grid, const std::optional<DensityMetadata>& metadata,
             const std::optional<double>& asked) {
    const double iso = asked.value_or(metadata ? metadata->iso : 0.5);
    if (!std::isfinite(iso) || !isAboveBackground(iso, grid.background())) {
        std::ostringstream message;
        const bool isStored = !asked && metadata;
        message << "the iso-value " << (isStored ? "stored in the grid " : "") << "is " << iso
                << "; it must be above the grid's background, " << grid.background()
                << (iso > grid.background() ? ", by more than a float is rounded" : "");
        throw Error(asked ? ErrorKind::Usage : ErrorKind::Input, message.str());
    }
    return iso;
}

bool needsFraming(const CameraOptions& camera) {
    const bool isSized =
        camera.projection == CameraOptions::Projection::Perspective || camera.frame > 0;
    return !(camera.eye && camera.lookat && isSized);
}

std::vector<openvdb::Vec3d> activePoints(const openvdb::FloatGrid& grid, const Progress& progress) {
    const auto boxOf = [](const DensityLeaf& leaf) {
        openvdb::CoordBBox box;
        leaf.evalActiveBoundingBox(box);
        return box;
    };
    return cornersOfNodes(grid, 0.5, progress, boxOf, grid.cbeginValueOn(),
                          [](float /*value*/) { return true; });
}

FramedPoints pointsToFrame(const Scene& scene, const Progress& progress) {
    FramedPoints points;
    for (const SceneObject& object : scene.objects) {
        append(points.active, activePoints(*object.grid, progress));
        // What bandvox has band-limited is active as far as it is more than nothing.
        const bool isAveraged =
            object.kind == SceneObject::Kind::Volume && !densityMetadata(*object.grid);
        if (isAveraged) append(points.faint, pointsOfAverages(*object.grid, progress));
    }
    return points;
}

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

void failEmpty(double maximum, double iso) {
    std::ostringstream message;
    message << "nothing to see: the density is at most " << maximum << ", below the iso-value "
            << iso;
    throw Error(ErrorKind::Result, message.str());
}

void requireHits(const RenderResult& result, double maximum, double iso) {
    if (result.hits > 0) return;
    std::ostringstream message;
    message << "nothing to see: ";
    if (maximum < iso) {
        message << "the density reaches " << maximum << " only, below the iso-value " << iso;
    } else {
        message << "none of " << result.rays
                << " lines of sight meets the surface; expected the camera to face it";
    }
    throw Error(ErrorKind::Result, message.str());
}

}  // namespace bandvox

#include "render/picture_request.h"

#include <bandvox/core/error.h>

#include <cmath>
#include <sstream>
#include <string>

namespace bandvox {

namespace {

constexpr int kLargestSide = 65536;
constexpr int kMostSamples = 4096;

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

}  // namespace

void failNotFinite(const openvdb::FloatGrid& grid) {
    throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                      "\" has values that are not finite; expected a density");
}

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

void requireDrawable(const openvdb::FloatGrid& grid) {
    const std::string name = "the grid \"" + grid.getName() + "\" ";
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Input, name + "has a transform of type " +
                                          grid.transform().mapType() +
                                          ", which bends lines of sight; expected a linear one");
    }
    if (grid.evalActiveVoxelBoundingBox().empty()) {
        throw Error(ErrorKind::Input,
                    name + "has no active voxel; expected a density or a level set");
    }
    if (!std::isfinite(grid.background())) failNotFinite(grid);
}

double isoOf(const openvdb::FloatGrid& grid, const std::optional<DensityMetadata>& metadata,
             const RenderOptions& options) {
    const double iso = options.iso.value_or(metadata ? metadata->iso : 0.5);
    if (!std::isfinite(iso) || !(iso > grid.background())) {
        std::ostringstream message;
        const bool isStored = !options.iso && metadata;
        message << "the iso-value " << (isStored ? "stored in the grid " : "") << "is " << iso
                << "; it must be above the grid's background, " << grid.background();
        throw Error(options.iso ? ErrorKind::Usage : ErrorKind::Input, message.str());
    }
    return iso;
}

std::vector<openvdb::Vec3d> activePoints(const openvdb::FloatGrid& grid) {
    std::vector<openvdb::Vec3d> points;
    const auto add = [&](const openvdb::CoordBBox& voxels) {
        if (voxels.empty()) return;
        for (int i = 0; i < 8; ++i) {
            openvdb::Vec3d corner;
            for (int axis = 0; axis < 3; ++axis) {
                corner[axis] =
                    (i >> axis & 1) != 0 ? voxels.max()[axis] + 0.5 : voxels.min()[axis] - 0.5;
            }
            points.push_back(grid.indexToWorld(corner));
        }
    };
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        openvdb::CoordBBox box;
        leaf->evalActiveBoundingBox(box);
        add(box);
    }
    auto tile = grid.cbeginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) add(tile.getBoundingBox());
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

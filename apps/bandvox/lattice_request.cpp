#include "lattice_request.h"

#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/resample/resample_grid.h>

#include <algorithm>
#include <cmath>

namespace bandvox::app {
namespace {

// How far sides and angles of voxels may be from those of cubes, relative.
constexpr double kCubeTolerance = 1e-6;

bool hasCubes(const openvdb::math::Transform& transform) {
    if (!transform.isLinear()) return false;
    const auto map = transform.baseMap();
    const openvdb::Vec3d axes[] = {map->applyJacobian({1, 0, 0}), map->applyJacobian({0, 1, 0}),
                                   map->applyJacobian({0, 0, 1})};
    const double square = axes[0].lengthSqr();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j <= i; ++j) {
            const double expected = i == j ? square : 0;
            if (std::abs(axes[i].dot(axes[j]) - expected) > kCubeTolerance * square) return false;
        }
    }
    return true;
}

// Cubes of this side along the grid's axes; of axes that are no right angle apart, the second and
// the third as near to them as can be.
openvdb::math::Transform::Ptr cubesAlong(const openvdb::GridBase& grid, double side) {
    openvdb::Mat4d matrix = uniformLattice(grid, side)->baseMap()->getAffineMap()->getMat4();
    openvdb::Vec3d axes[3];
    for (int i = 0; i < 3; ++i) {
        axes[i] = {matrix(i, 0), matrix(i, 1), matrix(i, 2)};
        for (int j = 0; j < i; ++j) axes[i] -= axes[i].dot(axes[j]) / (side * side) * axes[j];
        axes[i] *= side / axes[i].length();
        for (int k = 0; k < 3; ++k) matrix(i, k) = axes[i][k];
    }
    return openvdb::math::Transform::createLinearTransform(matrix);
}

}  // namespace

LatticeRequest readLattice(const CommandLine& line) {
    LatticeRequest lattice;
    int count = 0;
    for (const char* name : {"resolution", "voxel-size", "factor", "onto"}) {
        if (line.has(name)) ++count;
    }
    if (count > 1) {
        throw Error(ErrorKind::Usage,
                    "expected one of --resolution, --voxel-size, --factor and --onto, but got " +
                        std::to_string(count));
    }
    if (line.has("resolution")) {
        lattice.resolution = line.wholeNumber("resolution", 1, 1 << 20, 1);
    }
    const Range positive{.low = 0, .lowOpen = true};
    if (line.has("voxel-size")) lattice.voxelSize = line.number("voxel-size", positive, 1);
    if (line.has("factor")) {
        lattice.factor = line.number("factor", {.low = 0.01, .high = 1e4}, 1);
    }
    lattice.onto = line.text("onto");
    return lattice;
}

openvdb::GridBase::ConstPtr readOnto(const LatticeRequest& request) {
    if (!request.onto) return nullptr;
    const openvdb::GridPtrVec grids = readGrids(*request.onto);
    if (grids.empty()) {
        throw Error(ErrorKind::Input, "'" + *request.onto + "' has no grids, so no lattice");
    }
    return grids.front()->copyGridWithNewTree();
}

openvdb::math::Transform::Ptr targetFor(const openvdb::GridBase& grid,
                                        const LatticeRequest& request,
                                        const openvdb::GridBase::ConstPtr& onto) {
    if (onto) {
        const std::string difference = placeDifference(grid, *onto);
        if (difference.empty()) return onto->transform().copy();
        throw Error(ErrorKind::Input, "the grid '" + grid.getName() + "' and that of --onto '" +
                                          request.onto.value_or("") +
                                          "' are not in one world: " + difference);
    }
    if (request.voxelSize) return uniformLattice(grid, *request.voxelSize);
    if (request.resolution) {
        const openvdb::Vec3d size =
            grid.voxelSize() * grid.evalActiveVoxelBoundingBox().dim().asVec3d();
        const double longest = std::max({size[0], size[1], size[2]});
        return uniformLattice(grid, longest / *request.resolution);
    }
    auto target = grid.transform().copy();
    if (request.factor) target->preScale(*request.factor);
    return target;
}

openvdb::math::Transform::Ptr cubesFor(const openvdb::GridBase& grid, const LatticeRequest& request,
                                       const openvdb::GridBase::ConstPtr& onto) {
    auto target = targetFor(grid, request, onto);
    if (hasCubes(*target)) return target;
    if (onto && request.onto) {
        throw Error(
            ErrorKind::Usage,
            "--onto '" + *request.onto +
                "' names a lattice whose voxels are no cubes, which a solid needs; expected "
                "another one, or --voxel-size");
    }
    const openvdb::Vec3d size = target->voxelSize();
    return cubesAlong(grid, std::min({size[0], size[1], size[2]}));
}

}  // namespace bandvox::app

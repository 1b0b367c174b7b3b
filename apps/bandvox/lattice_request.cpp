#include "lattice_request.h"

#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/resample/cubic_lattice.h>
#include <bandvox/resample/resample_grid.h>

#include <algorithm>

namespace bandvox::app {

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
    if (hasCubicVoxels(*target)) return target;
    if (onto && request.onto) {
        throw Error(
            ErrorKind::Usage,
            "--onto '" + *request.onto +
                "' names a lattice whose voxels are no cubes, which a solid needs; expected "
                "another one, or --voxel-size");
    }
    const openvdb::Vec3d size = target->voxelSize();
    return cubicLattice(grid, std::min({size[0], size[1], size[2]}));
}

}  // namespace bandvox::app

#include "lattice_arguments.h"

#include "grid_object.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/resample/resample_grid.h>

#include <algorithm>
#include <string>

namespace bandvox::python {

openvdb::math::Transform::Ptr targetOf(const openvdb::GridBase& grid,
                                       const LatticeArguments& lattice) {
    if (lattice.count() > 1) {
        throw Error(ErrorKind::Usage,
                    "expected one of resolution, factor, voxel_size and onto, but got " +
                        std::to_string(lattice.count()));
    }
    if (!lattice.onto.is_none()) {
        const auto onto = gridOf(lattice.onto);
        const std::string difference = placeDifference(grid, *onto);
        if (difference.empty()) return onto->transform().copy();
        throw Error(ErrorKind::Input,
                    "the grid and that of onto are not in one world: " + difference);
    }
    if (lattice.voxelSize != 0) return uniformLattice(grid, lattice.voxelSize);
    if (lattice.resolution != 0) {
        if (lattice.resolution < 1) {
            throw Error(ErrorKind::Usage, "resolution is " + std::to_string(lattice.resolution) +
                                              "; expected 1 or more");
        }
        const openvdb::Vec3d size =
            grid.voxelSize() * grid.evalActiveVoxelBoundingBox().dim().asVec3d();
        return uniformLattice(grid, std::max({size[0], size[1], size[2]}) / lattice.resolution);
    }
    auto target = grid.transform().copy();
    if (lattice.factor != 0) {
        if (!(lattice.factor >= 0.01 && lattice.factor <= 1e4)) {
            throw Error(ErrorKind::Usage,
                        "factor is " + std::to_string(lattice.factor) + "; expected 0.01 to 10000");
        }
        target->preScale(lattice.factor);
    }
    return target;
}

}  // namespace bandvox::python

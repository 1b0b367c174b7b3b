#pragma once

#include "command_line.h"

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

namespace bandvox::app {

/// The lattice that grids are brought to: one of these, or none.
struct LatticeRequest {
    std::optional<int> resolution;
    std::optional<double> voxelSize;
    std::optional<double> factor;
    std::optional<std::string> onto;

    bool isSame() const { return !resolution && !voxelSize && !factor && !onto; }
};

/// --resolution, --voxel-size, --factor, --onto. Throws Error(ErrorKind::Usage) if several are
/// there.
LatticeRequest readLattice(const CommandLine& line);

/// The first grid of the file that --onto names, without its voxels; null without. Throws
/// Error(ErrorKind::Input) if it has no grids.
openvdb::GridBase::ConstPtr readOnto(const LatticeRequest& request);

/// The lattice for a grid of any type. `onto`: what readOnto gave. Throws Error(ErrorKind::Input)
/// if that says that it lies in another world.
openvdb::math::Transform::Ptr targetFor(const openvdb::GridBase& grid,
                                        const LatticeRequest& request,
                                        const openvdb::GridBase::ConstPtr& onto);

/// The same for what becomes a solid, whose voxels have to be cubes: without a request of the side
/// that the grid's voxels have where they are shortest. Throws Error(ErrorKind::Usage) for another
/// lattice that --onto asks for.
openvdb::math::Transform::Ptr cubesFor(const openvdb::GridBase& grid, const LatticeRequest& request,
                                       const openvdb::GridBase::ConstPtr& onto);

}  // namespace bandvox::app

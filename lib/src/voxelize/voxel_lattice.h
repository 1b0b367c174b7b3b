#pragma once

#include <bandvox/voxelize/voxels.h>

#include <openvdb/math/BBox.h>

#include <cstdint>
#include <string>

namespace bandvox {

/// The voxels that a solid may fill, and the leaf nodes that hold them. A column is what leaf
/// nodes that differ only in x cover: 8 × 8 rows of voxels.
struct VoxelLattice {
    double voxelSize;           ///< world units
    openvdb::CoordBBox voxels;  ///< all whose centres may be inside
    openvdb::Coord firstBlock;  ///< of the leaf nodes: voxel / 8
    openvdb::Coord blockCount;  ///< leaf nodes along each axis

    std::int64_t columnCount() const {
        return static_cast<std::int64_t>(blockCount.y()) * blockCount.z();
    }

    /// The first leaf node of a column, as voxel / 8; columns are counted along z first.
    openvdb::Coord columnBlock(std::int64_t column) const {
        return firstBlock + openvdb::Coord(0, static_cast<int>(column / blockCount.z()),
                                           static_cast<int>(column % blockCount.z()));
    }
};

/// Lays out the lattice for a source, which `name` names in messages. `bounds`: world units.
/// Throws Error(ErrorKind::Usage) for options out of range, more than 2^20 voxels along a side or
/// indices beyond 2^30, Error(ErrorKind::Input) if the box has no size.
VoxelLattice layOutVoxels(const std::string& name, const openvdb::BBoxd& bounds,
                          const VoxelOptions& options);

/// Throws Error(ErrorKind::Memory) if a grid on the lattice would not fit into memory. `area`: of
/// the solid's surface, world units².
void requireVoxelMemory(const VoxelLattice& lattice, double area);

}  // namespace bandvox

#pragma once

#include <bandvox/voxelize/voxels.h>

#include <openvdb/math/BBox.h>

#include <array>
#include <cstdint>
#include <string>

namespace bandvox {

/// The axes of the grid in the order of a scan's own: along a row first, then the others, rising.
constexpr std::array<int, 3> scanOrder(ScanAxis axis) {
    if (axis == ScanAxis::X) return {0, 1, 2};
    if (axis == ScanAxis::Y) return {1, 0, 2};
    return {2, 0, 1};
}

/// The voxels that a solid may fill, and the leaf nodes that hold them, in the order of a scan: its
/// x is along the rows, whichever axis of the grid that is. A column is what leaf nodes that
/// differ only in x cover: 8 × 8 rows of voxels.
struct VoxelLattice {
    double voxelSize;           ///< world units
    double offset = 0;          ///< of a voxel's sample from its index along each axis, voxels
    ScanAxis axis;              ///< of the grid, that rows lie along
    openvdb::CoordBBox voxels;  ///< all whose samples may be inside
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

    /// The first voxel of the first leaf node.
    openvdb::Coord corner() const;

    /// The place in the grid of a voxel, or of a leaf node.
    openvdb::Coord inGrid(const openvdb::Coord& place) const;

    /// Where a voxel's sample lies, world units.
    openvdb::Vec3d sample(const openvdb::Coord& voxel) const;
};

/// Lays out the lattice for a source, which `name` names in messages. `bounds`: world units.
/// Throws Error(ErrorKind::Usage) for options out of range, more than 2^20 voxels along a side or
/// indices beyond 2^30, Error(ErrorKind::Input) if the box has no size.
VoxelLattice layOutVoxels(const std::string& name, const openvdb::BBoxd& bounds,
                          const VoxelOptions& options);

/// The lattice of the sub-samples: twice as fine. Those of voxel i are 2i and 2i + 1; its leaf
/// nodes are all that those of the voxels hold.
VoxelLattice subSampleLattice(const VoxelLattice& lattice);

/// Throws Error(ErrorKind::Memory) if a grid on the lattice would not fit into memory. `area`: of
/// the solid's surface, world units².
void requireVoxelMemory(const VoxelLattice& lattice, double area);

}  // namespace bandvox

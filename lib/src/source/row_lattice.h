#pragma once

#include <vector>

namespace bandvox {

/// Rows along x, the same in every voxel. Voxel i covers [i, i + 1) along y and z here.
///
/// P² + 1 rows pass through a voxel, at the points (i, P i mod n) / n, n = P² + 1. That is a square
/// lattice turned by atan(1 / P). No two of its points in a voxel have y or z in common: so a face
/// along y or z, which the rows of a lattice along the axes meet all or not at all, is met by a
/// part of them that is right to 1 / n.
///
/// Half a step away from the voxels' corners and middles: faces there meet no row.
struct RowLattice {
    double voxelSize = 1;  ///< world units
    int perSide = 1;       ///< P

    struct Place {
        double y, z;  ///< in [0, 1)
    };
    std::vector<Place> rows;  ///< of a voxel

    int rowCount() const { return static_cast<int>(rows.size()); }

    static RowLattice turned(double voxelSize, int perSide);
    /// One row to a voxel, at the same place along y and z in each.
    static RowLattice oneToAVoxel(double voxelSize, double place) {
        return {voxelSize, 1, {{place, place}}};
    }

    /// Of the turned lattice those rows of a voxel that make up one twice as wide, whose period is
    /// two voxels. `y`, `z`: the voxel.
    bool isOfWiderLattice(int y, int z, int row) const;
};

}  // namespace bandvox

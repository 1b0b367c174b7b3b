#pragma once

#include <vector>

namespace bandvox {

/// Rows along x, the same in every voxel. Voxel i covers [i, i + 1) along y and z here.
///
/// `perSide`² rows pass through a voxel, at the points of a lattice of rank 1, (i, a i mod n) / n.
/// No two of them have y or z in common: so a face along y or z, which rows on a square lattice
/// meet all or not at all, is met by part of them that is right to 1 / n. `a` is chosen so that the
/// shortest wave that the lattice takes for a constant, which lies askew, is as short as can be.
///
/// Half a step away from the voxels' corners and middles: faces there meet no row.
struct RowLattice {
    double voxelSize = 1;  ///< world units
    int perSide = 1;

    struct Place {
        double y, z;  ///< in [0, 1)
    };
    std::vector<Place> rows;  ///< of a voxel; every fourth make up a lattice of half `perSide`

    int rowCount() const { return static_cast<int>(rows.size()); }

    static RowLattice ofRank1(double voxelSize, int perSide);
    /// One row to a voxel, at the same place along y and z in each.
    static RowLattice oneToAVoxel(double voxelSize, double place) {
        return {voxelSize, 1, {{place, place}}};
    }
};

}  // namespace bandvox

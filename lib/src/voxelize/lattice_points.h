#pragma once

#include "voxelize/voxel_lattice.h"

#include <bandvox/source/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace bandvox {

// A rounded coordinate is off by 2^-18 voxels at most, a point by 6.6e-6. On a lattice of 2^14
// voxels a coordinate fits into 31 bits, which is what the GPU takes.
constexpr int kFractionBits = 17;
constexpr std::int64_t kVoxel = std::int64_t(1) << kFractionBits;

/// A point in the order of the scan, from the sample of the lattice's corner(), fixed point.
using LatticePoint = std::array<std::int64_t, 3>;

/// The points of a mesh on a lattice. Each is rounded once, so the triangles around it stay
/// together, and all that is computed from them is exact. Throws Error(ErrorKind::Memory) before
/// allocating if they would not fit.
std::vector<LatticePoint> roundToLattice(const Mesh& mesh, const VoxelLattice& lattice);

/// The least lattice index not below a coordinate.
constexpr int ceilVoxel(std::int64_t coordinate) {
    return static_cast<int>((coordinate + kVoxel - 1) >> kFractionBits);
}

/// A plane's normal in the order of a scan, only its signs being looked at: true if a sample that
/// lies on the plane counts as behind it, on the way along x. It stands for the place (x + ε,
/// y + ε², z + ε³) next to it, in the order of the grid's axes and in the limit of small ε.
template <typename Number>
constexpr bool isBehindItself(const std::array<Number, 3>& normal, ScanAxis axis) {
    const std::array<int, 3> order = scanOrder(axis);
    for (int gridAxis = 0; gridAxis < 3; ++gridAxis) {
        for (int i = 0; i < 3; ++i) {
            if (order[i] == gridAxis && normal[i] != 0) return (normal[i] > 0) == (normal[0] > 0);
        }
    }
    return false;
}

}  // namespace bandvox

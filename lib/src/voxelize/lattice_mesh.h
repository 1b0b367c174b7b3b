#pragma once

#include "voxelize/bit_column.h"
#include "voxelize/lattice_points.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/source/mesh.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace bandvox {

/// A mesh in whole numbers on a lattice, and which of its triangles each column may meet. What is
/// asked of it is answered exactly.
///
/// A row of voxel centres (y, z) stands for the line through (y + ε, z + ε²), in the limit of
/// small ε. It never meets an edge, so it crosses a closed mesh as often inwards as outwards.
class LatticeMesh {
  public:
    /// Points are rounded to 2^-17 voxels. Keeps references to both. Throws
    /// Error(ErrorKind::Memory) before allocating if it would not fit.
    LatticeMesh(const Mesh& mesh, const VoxelLattice& lattice);

    /// Appends the crossings of all rows of a column. `block`: its place, voxel / 8.
    void cross(const openvdb::Coord& block, std::vector<RowCrossing>& crossings) const;

  private:
    struct Plane;
    struct Interval {
        int begin, end;
    };

    const LatticePoint& point(std::uint32_t triangle, int corner) const {
        return mPoints[mMesh.triangles[triangle][corner]];
    }
    void forEachColumn(std::uint32_t triangle,
                       const std::function<void(std::int64_t)>& visit) const;
    Interval rowsOf(std::uint32_t triangle, int z) const;
    Interval reachBetween(std::uint32_t triangle, int zBegin, int zEnd) const;

    const Mesh& mMesh;
    const VoxelLattice& mLattice;
    std::vector<LatticePoint> mPoints;
    std::vector<std::uint64_t> mStart;  // of each column in mTriangles, and the end
    std::vector<std::uint32_t> mTriangles;
};

}  // namespace bandvox

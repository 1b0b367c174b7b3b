#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace bandvox::experiments {

/// The method that the paper compares with: N. Nakamura et al., "Fast Generation Method from
/// Boundary Representation Model to Binary Voxel Data by Using GPU", section 2. Each triangle is
/// tested against each voxel of its box (not of the whole space), and what those voxels surround is
/// filled. On one thread, without anything clever.
class TriangleVoxels {
  public:
    /// Voxels as those of meshToVoxels: voxel i's centre at i · voxelSize. The mesh is closed.
    TriangleVoxels(const Mesh& mesh, double voxelSize);

    const openvdb::Coord& count() const { return mCount; }
    /// Voxels that the surface passes through, and those.
    std::int64_t boundaryVoxels() const { return mBoundary; }
    /// Those and what they surround.
    std::int64_t voxels() const { return mInside; }

  private:
    enum State : std::uint8_t { kUnknown, kBoundary, kOutside };
    void markBoundary(const Mesh& mesh, double voxelSize);
    void floodOutside();
    std::size_t index(const openvdb::Coord& voxel) const {
        return (static_cast<std::size_t>(voxel.x()) * mCount.y() + voxel.y()) * mCount.z() +
               voxel.z();
    }

    openvdb::Coord mFirst, mCount;  // a voxel wider than the mesh on each side
    std::vector<std::uint8_t> mState;
    std::int64_t mBoundary = 0, mInside = 0;
};

}  // namespace bandvox::experiments

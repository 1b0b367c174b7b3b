#pragma once

#include "mesh/lattice_blocks.h"

#include <bandvox/reconstruct/reconstruction.h>

#include <openvdb/openvdb.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace bandvox {

/// The edges of a block whose ends lie on different sides of the surface. An edge belongs to the
/// block of its lower end.
class CrossedEdges {
  public:
    CrossedEdges(const BlockValues& values, double iso);

    int count() const { return mCount; }

    /// How many come before the one along `axis` from a node of the block; in the order of axes,
    /// then of nodes.
    int rank(int axis, int node) const {
        const int bit = axis * kNodes + node;
        const std::uint64_t below = (std::uint64_t(1) << (bit & 63)) - 1;
        return mBefore[bit >> 6] + std::popcount(mCrossed[bit >> 6] & below);
    }

    /// Calls visit(axis, node) for each, in that order; node = (8·x + y)·8 + z.
    template <typename Visit>
    void forEach(const Visit& visit) const {
        for (int word = 0; word < kWords; ++word) {
            for (std::uint64_t rest = mCrossed[word]; rest != 0; rest &= rest - 1) {
                const int bit = word * 64 + std::countr_zero(rest);
                visit(bit / kNodes, bit % kNodes);
            }
        }
    }

  private:
    static constexpr int kNodes = kBlockSide * kBlockSide * kBlockSide;
    static constexpr int kWords = 3 * kNodes / 64;

    std::array<std::uint64_t, kWords> mCrossed{};
    std::array<std::uint16_t, kWords> mBefore;
    int mCount = 0;
};

/// An edge of the lattice and what its ends, of which one is inside, are above the iso-value.
struct LatticeEdge {
    openvdb::Coord node;  ///< its lower end
    int axis;
    double low, high;  ///< of the lower end and of the upper one
};

/// A place on the surface.
struct SurfacePlace {
    openvdb::Vec3d index;     ///< voxels
    openvdb::Vec3d gradient;  ///< per voxel, along the index axes
};

/// A place on an edge that is no farther than `tolerance`, voxels, from the surface. It is not
/// nearer than half of that to the edge's ends, so that places on edges that meet are apart.
SurfacePlace findCrossing(DensityProbe& probe, const LatticeEdge& edge, double iso,
                          double tolerance);

/// The place on the surface that is reached from a place near it along the gradient, no farther
/// than a voxel away along any axis; the place itself if there is none.
SurfacePlace projectToSurface(DensityProbe& probe, const openvdb::Vec3d& index, double iso,
                              double tolerance);

}  // namespace bandvox

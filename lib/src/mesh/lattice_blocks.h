#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <vector>

namespace bandvox {

/// Nodes along the side of a block, which are those of a leaf.
constexpr int kBlockSide = 8;
/// The same and the nodes beyond its last cells.
constexpr int kBlockNodes = kBlockSide + 1;

/// First nodes of blocks that together have all cells whose corners lie on both sides of `iso`; a
/// cell belongs to the block of its lowest corner. Each once, those in one cube of `group` nodes, a
/// power of two, behind one another. The background has to be below `iso`.
std::vector<openvdb::Coord> candidateBlocks(const openvdb::FloatGrid& grid, double iso, int group);

/// The values of a block's nodes and of those beyond them, [x][y][z].
class BlockValues {
  public:
    /// Throws Error(ErrorKind::Input) if a value is not finite.
    void read(const openvdb::FloatGrid& grid, const openvdb::Coord& origin);

    float at(int x, int y, int z) const { return mValues[(x * kBlockNodes + y) * kBlockNodes + z]; }

    /// True if they lie on both sides of `iso`.
    bool crosses(double iso) const;

    /// Which corners of a cell are inside, one bit each.
    unsigned inside(int x, int y, int z, double iso) const;

  private:
    std::array<float, kBlockNodes * kBlockNodes * kBlockNodes> mValues;
};

}  // namespace bandvox

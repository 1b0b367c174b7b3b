#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/tile_plan.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace bandvox {

/// The tiles that have one value each, because no surface is near: most of a large grid. They are
/// kept as that, so that memory follows the surface.
class FarTiles {
  public:
    explicit FarTiles(const TileLayout& layout);

    /// Takes the far values out of columns, which are in the order of the layout's (y, z), the
    /// first of them number `begin`. Of those that have not been given, all tiles are 0.
    void take(std::int64_t begin, std::vector<ColumnBlocks>& columns);

    /// The one value of all voxels of `box`, if it lies in far tiles of one value only; voxels
    /// outside of the layout are 0.
    std::optional<float> valueIn(const openvdb::CoordBBox& box) const;

    /// Sets those of a leaf's voxels that lie in far tiles.
    void complete(DensityLeaf& leaf) const;

    /// All voxels of the layout.
    openvdb::CoordBBox voxels() const;

  private:
    openvdb::CoordBBox tilesOf(const openvdb::CoordBBox& box) const;
    bool isInside(const openvdb::Coord& tile) const;
    float at(const openvdb::Coord& tile) const;  // NaN if it is near; 0 outside of the layout

    const TileLayout& mLayout;
    std::vector<std::vector<float>> mColumns;  // [y][z][x]
};

}  // namespace bandvox

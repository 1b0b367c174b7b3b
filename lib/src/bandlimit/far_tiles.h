#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/tile_plan.h"

#include <optional>
#include <vector>

namespace bandvox {

/// The tiles that have one value each, because no surface is near: most of a large grid. They are
/// kept as that, so that memory follows the surface.
class FarTiles {
  public:
    /// Takes the far values out of the columns, which are in the order of the layout's (y, z).
    FarTiles(std::vector<ColumnBlocks>& columns, const TileLayout& layout);

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

#include "bandlimit/far_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {

namespace {

int floorDivide(int a, int b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

}  // namespace

FarTiles::FarTiles(const TileLayout& layout)
    : mLayout(layout), mColumns(static_cast<std::size_t>(layout.count.y()) * layout.count.z()) {}

void FarTiles::take(std::int64_t begin, std::vector<ColumnBlocks>& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        mColumns[static_cast<std::size_t>(begin) + i] = std::move(columns[i].farValues);
    }
}

openvdb::CoordBBox FarTiles::voxels() const {
    return {mLayout.origin, mLayout.tileOrigin(mLayout.count) - openvdb::Coord(1)};
}

openvdb::CoordBBox FarTiles::tilesOf(const openvdb::CoordBBox& box) const {
    openvdb::CoordBBox tiles;
    for (int axis = 0; axis < 3; ++axis) {
        const int origin = mLayout.origin[axis];
        tiles.min()[axis] = floorDivide(box.min()[axis] - origin, mLayout.interior);
        tiles.max()[axis] = floorDivide(box.max()[axis] - origin, mLayout.interior);
    }
    return tiles;
}

bool FarTiles::isInside(const openvdb::Coord& tile) const {
    return openvdb::CoordBBox(openvdb::Coord(0), mLayout.count - openvdb::Coord(1)).isInside(tile);
}

float FarTiles::at(const openvdb::Coord& tile) const {
    if (!isInside(tile)) return 0;
    const std::vector<float>& column =
        mColumns[static_cast<std::size_t>(tile.y()) * mLayout.count.z() + tile.z()];
    return column.empty() ? 0 : column[tile.x()];
}

std::optional<float> FarTiles::valueIn(const openvdb::CoordBBox& box) const {
    const openvdb::CoordBBox tiles = tilesOf(box);
    const float first = at(tiles.min());
    if (std::isnan(first)) return std::nullopt;
    for (auto tile = tiles.begin(); tile; ++tile) {
        if (at(*tile) != first) return std::nullopt;
    }
    return first;
}

void FarTiles::complete(DensityLeaf& leaf) const {
    const openvdb::CoordBBox block = leaf.getNodeBoundingBox();
    const openvdb::CoordBBox tiles = tilesOf(block);
    for (auto tile = tiles.begin(); tile; ++tile) {
        const float value = at(*tile);
        if (value == 0 || std::isnan(value)) continue;
        openvdb::CoordBBox part =
            openvdb::CoordBBox::createCube(mLayout.tileOrigin(*tile), mLayout.interior);
        part.intersect(block);
        for (auto voxel = part.begin(); voxel; ++voxel) {
            leaf.setValueOnly(DensityLeaf::coordToOffset(*voxel), value);
        }
    }
}

}  // namespace bandvox

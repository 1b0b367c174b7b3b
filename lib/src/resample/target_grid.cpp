#include "resample/target_grid.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

float StorageRule::stored(float value) const {
    if (std::abs(value - background) <= threshold) return background;
    for (const float anchor : anchors) {
        if (std::abs(value - anchor) <= threshold) return anchor;
    }
    const float whole = std::nearbyint(value);
    return wholeNumbers && std::abs(value - whole) <= threshold ? whole : value;
}

void GridPart::note(float value) {
    mMinimum = std::min(mMinimum, value);
    mMaximum = std::max(mMaximum, value);
}

void GridPart::addCube(const openvdb::Coord& origin, int side, std::span<const float> values,
                       const StorageRule& rule) {
    constexpr int kSide = Leaf::DIM;
    openvdb::Coord at;
    for (at[0] = 0; at[0] < side; at[0] += kSide) {
        for (at[1] = 0; at[1] < side; at[1] += kSide) {
            for (at[2] = 0; at[2] < side; at[2] += kSide) {
                auto leaf = std::make_unique<Leaf>(origin + at, rule.background);
                float* to = leaf->buffer().data();
                bool isConstant = true;
                Leaf::NodeMaskType active;
                for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
                    const openvdb::Coord voxel = at + Leaf::offsetToLocalCoord(i);
                    const std::size_t from =
                        (static_cast<std::size_t>(voxel[0]) * side + voxel[1]) * side + voxel[2];
                    to[i] = rule.stored(values[from]);
                    if (to[i] != rule.background) active.setOn(i);
                    isConstant = isConstant && to[i] == to[0];
                    note(to[i]);
                }
                if (active.isOff()) continue;
                if (isConstant) {
                    mTiles.push_back({leaf->origin(), to[0], true});
                    continue;
                }
                leaf->setValueMask(active);
                mLeaves.push_back(std::move(leaf));
            }
        }
    }
}

void GridPart::addConstant(const openvdb::Coord& origin, int side, float value, bool active) {
    constexpr int kSide = Leaf::DIM;
    note(value);
    openvdb::Coord at;
    for (at[0] = 0; at[0] < side; at[0] += kSide) {
        for (at[1] = 0; at[1] < side; at[1] += kSide) {
            for (at[2] = 0; at[2] < side; at[2] += kSide) {
                mTiles.push_back({origin + at, value, active});
            }
        }
    }
}

void GridPart::moveTo(openvdb::FloatTree& tree) {
    for (const Tile& tile : mTiles) tree.addTile(1, tile.origin, tile.value, tile.active);
    for (std::unique_ptr<Leaf>& leaf : mLeaves) tree.addLeaf(leaf.release());
    mTiles.clear();
    mLeaves.clear();
}

}  // namespace bandvox

#include "grid/copy_box.h"

#include <algorithm>

namespace bandvox {

bool copyBox(const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& from,
             const openvdb::CoordBBox& box, float* to, std::size_t planePitch,
             std::size_t rowPitch) {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    constexpr int kSide = Leaf::DIM;
    const float first = from.getValue(box.min());
    const openvdb::Coord begin = box.min() & ~(kSide - 1);
    bool isUniform = true;
    openvdb::Coord block;
    for (block[0] = begin[0]; block[0] <= box.max()[0]; block[0] += kSide) {
        for (block[1] = begin[1]; block[1] <= box.max()[1]; block[1] += kSide) {
            for (block[2] = begin[2]; block[2] <= box.max()[2]; block[2] += kSide) {
                openvdb::CoordBBox part = openvdb::CoordBBox::createCube(block, kSide);
                part.intersect(box);
                const Leaf* leaf = from.probeConstLeaf(block);
                const float* values = leaf ? leaf->buffer().data() : nullptr;
                const float tile = values ? first : from.getValue(block);
                const int length = part.dim()[2];
                int different = tile != first ? 1 : 0;
                for (int x = part.min()[0]; x <= part.max()[0]; ++x) {
                    for (int y = part.min()[1]; y <= part.max()[1]; ++y) {
                        const openvdb::Coord start(x, y, part.min()[2]);
                        const openvdb::Coord at = start - box.min();
                        float* row = to + at[0] * planePitch + at[1] * rowPitch + at[2];
                        if (!values) {
                            std::fill_n(row, length, tile);
                            continue;
                        }
                        const float* stored = values + Leaf::coordToOffset(start);
                        std::copy_n(stored, length, row);
                        for (int z = 0; z < length; ++z) different |= stored[z] != first ? 1 : 0;
                    }
                }
                isUniform = isUniform && different == 0;
            }
        }
    }
    return isUniform;
}

std::optional<float> valueOfLargeTiles(
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& from,
    const openvdb::CoordBBox& box) {
    // Values at this depth or above are those of tiles of 128³ voxels or more. A box no larger than
    // such a tile has a corner in each that it meets.
    constexpr int kLargeTile = 1, kSide = 128;
    const openvdb::Coord size = box.dim();
    if (std::max({size[0], size[1], size[2]}) > kSide) return std::nullopt;
    const float first = from.getValue(box.min());
    for (int i = 0; i < 8; ++i) {
        const openvdb::Coord corner((i & 1) != 0 ? box.max()[0] : box.min()[0],
                                    (i & 2) != 0 ? box.max()[1] : box.min()[1],
                                    (i & 4) != 0 ? box.max()[2] : box.min()[2]);
        if (from.getValueDepth(corner) > kLargeTile || from.getValue(corner) != first) {
            return std::nullopt;
        }
    }
    return first;
}

}  // namespace bandvox

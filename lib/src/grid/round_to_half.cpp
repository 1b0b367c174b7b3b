#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Compression.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

double roundToHalf(openvdb::FloatGrid& grid) {
    double largest = 0;
    const auto round = [&largest](float value) {
        const float rounded = openvdb::io::truncateRealToHalf(value);
        largest = std::max<double>(largest, std::abs(rounded - value));
        return rounded;
    };
    for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf) {
        float* values = leaf->buffer().data();
        std::transform(values, values + openvdb::FloatTree::LeafNodeType::SIZE, values, round);
    }
    auto tile = grid.tree().beginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(round(*tile));
    return largest;
}

}  // namespace bandvox

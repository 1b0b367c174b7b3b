#include "grid/constant_leaf.h"

#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Compression.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bandvox {

double roundToHalf(openvdb::FloatGrid& grid, Progress& progress) {
    double largest = 0;
    const auto round = [&largest](float value) {
        const float rounded = openvdb::io::truncateRealToHalf(value);
        largest = std::max<double>(largest, std::abs(rounded - value));
        return rounded;
    };
    std::vector<openvdb::Coord> constant;
    for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf) {
        progress.throwIfInterrupted();
        float* values = leaf->buffer().data();
        std::transform(values, values + openvdb::FloatTree::LeafNodeType::SIZE, values, round);
        if (isConstantLeaf(*leaf)) constant.push_back(leaf->origin());
    }
    // What differed by less than is kept has become tiles.
    for (const openvdb::Coord& origin : constant) {
        const float value = grid.tree().getValue(origin);  // which the leaf takes with it
        grid.tree().addTile(1, origin, value, /*active=*/true);
    }
    auto tile = grid.tree().beginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(round(*tile));
    openvdb::tools::pruneTiles(grid.tree(), 0.0F, /*threaded=*/false);
    return largest;
}

void roundAndRestate(openvdb::FloatGrid& grid, Progress& progress) {
    const double change = roundToHalf(grid, progress);
    auto metadata = densityMetadata(grid);
    if (!metadata) return;
    metadata->storageError = std::max(metadata->storageError, change);
    metadata->gridVolume = densityIntegral(grid, progress);
    setDensityMetadata(grid, *metadata);
}

}  // namespace bandvox

#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bandvox {

double densityIntegral(const openvdb::FloatGrid& grid) {
    // Sum each leaf by itself first, so that many small values are not lost beside a large sum.
    using Leaf = openvdb::FloatTree::LeafNodeType;
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    std::vector<double> sums(leaves.size());
    constexpr std::size_t kLeavesPerTask = 1024;
    const std::size_t tasks = (leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
        const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
        for (std::size_t i = begin; i < end; ++i) {
            for (auto value = leaves[i]->cbeginValueOn(); value; ++value) sums[i] += *value;
        }
    });
    double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
    auto tile = grid.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) sum += static_cast<double>(*tile) * tile.getVoxelCount();
    // A voxel's volume is the determinant of the map's linear part, which is negative of a mirror.
    return sum * std::abs(grid.transform().voxelVolume());
}

}  // namespace bandvox

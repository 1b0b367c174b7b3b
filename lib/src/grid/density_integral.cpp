#include "core/instruction_sets.h"
#include "grid/leaf_sums.h"

#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bandvox {

// In several sums at once, of which none waits for another.
BANDVOX_FOR_EACH_INSTRUCTION_SET
double sumOfActive(const openvdb::FloatTree::LeafNodeType& leaf) {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    constexpr openvdb::Index kSums = 16;
    using Word = openvdb::util::NodeMask<Leaf::LOG2DIM>::Word;
    constexpr openvdb::Index kBits = 8 * sizeof(Word);
    std::array<double, kSums> sums{};
    const float* values = leaf.buffer().data();
    for (openvdb::Index begin = 0; begin < Leaf::SIZE; begin += kBits) {
        const auto active = leaf.getValueMask().getWord<Word>(begin / kBits);
        for (openvdb::Index i = 0; i < kBits; i += kSums) {
            for (openvdb::Index l = 0; l < kSums; ++l) {
                sums[l] += (active >> (i + l) & 1) != 0 ? values[begin + i + l] : 0.0F;
            }
        }
    }
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double integralOf(const openvdb::FloatGrid& grid, const std::vector<double>& sums) {
    double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
    auto tile = grid.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) sum += static_cast<double>(*tile) * tile.getVoxelCount();
    // A voxel's volume is the determinant of the map's linear part, which is negative of a mirror.
    return sum * std::abs(grid.transform().voxelVolume());
}

double densityIntegral(const openvdb::FloatGrid& grid, Progress& progress) {
    // Sum each leaf by itself first, so that many small values are not lost beside a large sum.
    std::vector<const openvdb::FloatTree::LeafNodeType*> leaves;
    grid.tree().getNodes(leaves);
    std::vector<double> sums(leaves.size());
    constexpr std::size_t kLeavesPerTask = 1024;
    const std::size_t tasks = (leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
        const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
        for (std::size_t i = begin; i < end; ++i) {
            sums[i] = sumOfActive(*leaves[i]);
        }
    });
    return integralOf(grid, sums);
}

}  // namespace bandvox

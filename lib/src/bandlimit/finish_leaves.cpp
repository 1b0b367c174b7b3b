#include "bandlimit/finish_leaves.h"

#include "core/instruction_sets.h"

#include <bandvox/core/parallel.h>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace bandvox {

namespace {

constexpr std::size_t kLeavesPerTask = 256;

BANDVOX_FOR_EACH_INSTRUCTION_SET
void snapToWhole(float* values, float threshold) {
    for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) {
        const float whole = __builtin_rintf(values[v]);
        values[v] = std::abs(values[v] - whole) <= threshold ? whole : values[v];
    }
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void setNonzero(const float* values, DensityLeaf::NodeMaskType& active) {
    using Word = DensityLeaf::NodeMaskType::Word;
    constexpr openvdb::Index kBits = 8 * sizeof(Word);
    for (openvdb::Index n = 0; n < DensityLeaf::NodeMaskType::WORD_COUNT; ++n) {
        Word word = 0;
        for (openvdb::Index i = 0; i < kBits; ++i) {
            word |= Word(values[kBits * n + i] != 0 ? 1 : 0) << i;
        }
        active.getWord<Word>(n) = word;
    }
}

// What a column made of a block that goes on in others.
struct Piece {
    openvdb::Coord origin;
    std::unique_ptr<DensityLeaf> leaf;
};

std::vector<Piece> sortByPlace(LeafList leaves) {
    std::vector<Piece> pieces(leaves.size());
    forEachChunkOfLeaves(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            pieces[i] = {leaves[i]->origin(), std::move(leaves[i])};
        }
    });
    tbb::parallel_sort(pieces, [](const Piece& a, const Piece& b) { return a.origin < b.origin; });
    return pieces;
}

}  // namespace

void forEachChunkOfLeaves(std::size_t count,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t chunks = (count + kLeavesPerTask - 1) / kLeavesPerTask;
    parallelFor(static_cast<std::int64_t>(chunks), [&](std::int64_t chunk) {
        const std::size_t begin = chunk * kLeavesPerTask;
        body(begin, std::min(count, begin + kLeavesPerTask));
    });
}

void limitValues(DensityLeaf& leaf) {
    float* values = leaf.buffer().data();
    for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) {
        values[v] = std::clamp(values[v], 0.0F, 1.0F);
    }
}

bool activateNonzero(DensityLeaf& leaf) {
    DensityLeaf::NodeMaskType active;
    setNonzero(leaf.buffer().data(), active);
    leaf.setValueMask(active);
    return !active.isOff();
}

bool finishLeaf(DensityLeaf& leaf, const AssemblyOptions& options) {
    snapToWhole(leaf.buffer().data(), static_cast<float>(options.threshold));
    if (options.clamp) limitValues(leaf);
    return activateNonzero(leaf);
}

void finishLeaves(LeafList& leaves, const AssemblyOptions& options) {
    forEachChunkOfLeaves(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!finishLeaf(*leaves[i], options)) leaves[i].reset();
        }
    });
}

// Adds up the pieces of each block: every voxel was set by one piece and is 0 in the others, so
// that their order does not matter, or lies in a far tile. All pieces are given back together in
// the end, since tasks that free memory wait for each other.
JoinedBlocks joinPieces(LeafList leaves, const FarTiles& far, const AssemblyOptions& options) {
    std::vector<Piece> pieces = sortByPlace(std::move(leaves));
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i == 0 || pieces[i].origin != pieces[i - 1].origin) starts.push_back(i);
    }
    const std::size_t count = starts.size();
    starts.push_back(pieces.size());

    JoinedBlocks joined;
    joined.leaves.resize(count);
    joined.constant.resize(count, {openvdb::Coord(), 0});
    forEachChunkOfLeaves(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            std::unique_ptr<DensityLeaf> leaf = std::move(pieces[starts[block]].leaf);
            float* sum = leaf->buffer().data();
            for (std::size_t i = starts[block] + 1; i < starts[block + 1]; ++i) {
                const float* piece = pieces[i].leaf->buffer().data();
                for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) sum[v] += piece[v];
            }
            far.complete(*leaf);
            float value = 0;
            if (isConstant(*leaf, static_cast<float>(options.threshold), value)) {
                joined.constant[block] = {leaf->origin(), value};
            } else if (finishLeaf(*leaf, options)) {
                joined.leaves[block] = std::move(leaf);
            }
        }
    });
    return joined;
}

}  // namespace bandvox

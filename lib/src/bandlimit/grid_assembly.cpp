#include "bandlimit/grid_assembly.h"

#include "bandlimit/far_tiles.h"
#include "core/instruction_sets.h"

#include <bandvox/core/parallel.h>

#include <openvdb/tools/Prune.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace bandvox {

namespace {

using LeafList = std::vector<std::unique_ptr<DensityLeaf>>;

constexpr std::size_t kLeavesPerTask = 256;

void forEachChunk(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t chunks = (count + kLeavesPerTask - 1) / kLeavesPerTask;
    parallelFor(static_cast<std::int64_t>(chunks), [&](std::int64_t chunk) {
        const std::size_t begin = chunk * kLeavesPerTask;
        body(begin, std::min(count, begin + kLeavesPerTask));
    });
}

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

// Makes values next to a whole number that number, voxel by voxel, so that where the blocks lie
// does not show; sets which voxels are active. Returns false if none is.
bool finishLeaf(DensityLeaf& leaf, const AssemblyOptions& options) {
    float* values = leaf.buffer().data();
    snapToWhole(values, static_cast<float>(options.threshold));
    if (options.clamp) {
        for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) {
            values[v] = std::clamp(values[v], 0.0F, 1.0F);
        }
    }
    DensityLeaf::NodeMaskType active;
    setNonzero(values, active);
    leaf.setValueMask(active);
    return !active.isOff();
}

void finishLeaves(LeafList& leaves, const AssemblyOptions& options) {
    forEachChunk(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!finishLeaf(*leaves[i], options)) leaves[i].reset();
        }
    });
}

// What a column made of a block that goes on in others.
struct Piece {
    openvdb::Coord origin;
    std::unique_ptr<DensityLeaf> leaf;
};

std::vector<Piece> sortByPlace(LeafList leaves) {
    std::vector<Piece> pieces(leaves.size());
    forEachChunk(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            pieces[i] = {leaves[i]->origin(), std::move(leaves[i])};
        }
    });
    tbb::parallel_sort(pieces, [](const Piece& a, const Piece& b) { return a.origin < b.origin; });
    return pieces;
}

/// What pieces that were added up came to.
struct JoinedBlocks {
    LeafList leaves;  ///< finished; null where there is none
    std::vector<ConstantBlock> constant;
};

// Adds up the pieces of each block: every voxel was set by one piece and is 0 in the others, so
// that their order does not matter, or lies in a far tile. All pieces are given back together in
// the end, since tasks that free memory wait for each other.
JoinedBlocks joinPieces(std::vector<Piece> pieces, const FarTiles& far,
                        const AssemblyOptions& options) {
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i == 0 || pieces[i].origin != pieces[i - 1].origin) starts.push_back(i);
    }
    const std::size_t count = starts.size();
    starts.push_back(pieces.size());

    JoinedBlocks joined;
    joined.leaves.resize(count);
    joined.constant.resize(count, {openvdb::Coord(), 0});
    forEachChunk(count, [&](std::size_t begin, std::size_t end) {
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

// Calls visit(cube) for the cubes of this side, at multiples of it, that reach into a box.
template <typename Visit>
void forEachCube(const openvdb::CoordBBox& within, int side, const Visit& visit) {
    const openvdb::Coord low = within.min() & ~(side - 1);
    for (int x = low.x(); x <= within.max().x(); x += side) {
        for (int y = low.y(); y <= within.max().y(); y += side) {
            for (int z = low.z(); z <= within.max().z(); z += side) {
                visit(openvdb::CoordBBox::createCube(openvdb::Coord(x, y, z), side));
            }
        }
    }
}

// Makes tiles of what lies in far tiles only: cubes of 128³ voxels, and blocks of 8³ elsewhere.
void addFarTiles(const FarTiles& far, bool clamp, openvdb::FloatTree& tree) {
    using Node = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;
    const openvdb::CoordBBox box = far.voxels();
    std::vector<openvdb::CoordBBox> cubes;
    forEachCube(box, Node::DIM, [&](const openvdb::CoordBBox& cube) { cubes.push_back(cube); });

    // Find them.
    struct Found {
        std::optional<float> whole;
        std::vector<ConstantBlock> blocks;
    };
    std::vector<Found> found(cubes.size());
    parallelFor(static_cast<std::int64_t>(cubes.size()), [&](std::int64_t i) {
        openvdb::CoordBBox part = cubes[i];
        found[i].whole = far.valueIn(part);
        if (found[i].whole) return;
        part.intersect(box);
        forEachCube(part, DensityLeaf::DIM, [&](const openvdb::CoordBBox& block) {
            const auto value = far.valueIn(block);
            if (value && *value != 0) found[i].blocks.push_back({block.min(), *value});
        });
    });

    // Add them.
    const auto add = [&](openvdb::Index level, const openvdb::Coord& origin, float value) {
        if (clamp) value = std::clamp(value, 0.0F, 1.0F);
        if (value != 0) tree.addTile(level, origin, value, /*active=*/true);
    };
    for (std::size_t i = 0; i < cubes.size(); ++i) {
        if (found[i].whole) add(2, cubes[i].min(), *found[i].whole);
        for (const ConstantBlock& block : found[i].blocks) add(1, block.origin, block.value);
    }
}

void addConstant(const std::vector<ConstantBlock>& blocks, bool clamp, openvdb::FloatTree& tree) {
    for (const ConstantBlock& block : blocks) {
        const float value = clamp ? std::clamp(block.value, 0.0F, 1.0F) : block.value;
        if (value != 0) tree.addTile(1, block.origin, value, /*active=*/true);
    }
}

// Leaves that are next to each other in the list are so in the grid, and share a path in the tree.
void addLeaves(LeafList& leaves, openvdb::FloatTree& tree) {
    openvdb::tree::ValueAccessor<openvdb::FloatTree, false> accessor(tree);
    for (std::unique_ptr<DensityLeaf>& leaf : leaves) {
        if (leaf) accessor.addLeaf(leaf.release());
    }
}

// Keeps of blocks that go on in columns of others what far tiles have here: there is no piece of
// them that it could be added to.
void addBordersOfPart(const FarTiles& far, const AssemblyOptions& options,
                      openvdb::FloatTree& tree) {
    const openvdb::CoordBBox box = far.voxels();
    openvdb::tree::ValueAccessor<openvdb::FloatTree> accessor(tree);
    forEachCube(box, DensityLeaf::DIM, [&](const openvdb::CoordBBox& block) {
        if (far.valueIn(block) || accessor.probeConstLeaf(block.min()) ||
            accessor.isValueOn(block.min())) {
            return;
        }
        auto leaf = std::make_unique<DensityLeaf>(block.min(), 0.0F);
        far.complete(*leaf);
        if (finishLeaf(*leaf, options)) accessor.addLeaf(leaf.release());
    });
}

}  // namespace

openvdb::FloatGrid::Ptr assembleGrid(std::vector<ColumnBlocks>& columns, const TileLayout& layout,
                                     const AssemblyOptions& options) {
    // Gather what the columns made.
    LeafList leaves, pieces;
    std::vector<ConstantBlock> constant;
    for (ColumnBlocks& column : columns) {
        std::move(column.inner.begin(), column.inner.end(), std::back_inserter(leaves));
        std::move(column.border.begin(), column.border.end(), std::back_inserter(pieces));
        constant.insert(constant.end(), column.constant.begin(), column.constant.end());
    }
    const FarTiles far(columns, layout);
    columns.clear();
    finishLeaves(leaves, options);
    JoinedBlocks joined = joinPieces(sortByPlace(std::move(pieces)), far, options);

    auto grid = openvdb::FloatGrid::create(0.0F);
    openvdb::FloatTree& tree = grid->tree();
    addFarTiles(far, options.clamp, tree);
    addConstant(constant, options.clamp, tree);
    addConstant(joined.constant, options.clamp, tree);
    addLeaves(leaves, tree);
    addLeaves(joined.leaves, tree);
    if (options.isPart) addBordersOfPart(far, options, tree);
    openvdb::tools::pruneTiles(tree, 0.0F, /*threaded=*/false);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(layout.voxelSize));
    return grid;
}

}  // namespace bandvox

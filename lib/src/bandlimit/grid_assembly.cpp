#include "bandlimit/grid_assembly.h"

#include "bandlimit/far_tiles.h"

#include <bandvox/core/parallel.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

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

// Adds up the pieces of each block: every voxel was set by one piece and is 0 in the others, or
// lies in a far tile. What becomes constant goes to `constant`, the rest to `whole`.
void joinPieces(LeafList pieces, const FarTiles& far, float threshold, LeafList& whole,
                std::vector<ConstantBlock>& constant) {
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const auto& a, const auto& b) { return a->origin() < b->origin(); });
    for (std::size_t i = 0; i < pieces.size();) {
        std::unique_ptr<DensityLeaf> leaf = std::move(pieces[i]);
        float* sum = leaf->buffer().data();
        for (++i; i < pieces.size() && pieces[i]->origin() == leaf->origin(); ++i) {
            const float* piece = pieces[i]->buffer().data();
            for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) sum[v] += piece[v];
            pieces[i].reset();
        }
        far.complete(*leaf);
        float value = 0;
        if (!isConstant(*leaf, threshold, value)) {
            whole.push_back(std::move(leaf));
        } else if (value != 0) {
            constant.push_back({leaf->origin(), value});
        }
    }
}

// Makes values next to a whole number that number, voxel by voxel, so that where the blocks lie
// does not show; sets which voxels are active. Returns false if none is.
bool finishLeaf(DensityLeaf& leaf, const AssemblyOptions& options) {
    const auto threshold = static_cast<float>(options.threshold);
    float* values = leaf.buffer().data();
    DensityLeaf::NodeMaskType active;
    for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) {
        const float whole = std::nearbyint(values[v]);
        if (std::abs(values[v] - whole) <= threshold) values[v] = whole;
        if (options.clamp) values[v] = std::clamp(values[v], 0.0F, 1.0F);
        if (values[v] != 0) active.setOn(v);
    }
    leaf.setValueMask(active);
    return !active.isOff();
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
    constexpr int kNode = Node::DIM;
    const openvdb::CoordBBox box = far.voxels();
    const auto add = [&](openvdb::Index level, const openvdb::Coord& origin, float value) {
        if (clamp) value = std::clamp(value, 0.0F, 1.0F);
        if (value != 0) tree.addTile(level, origin, value, /*active=*/true);
    };
    forEachCube(box, kNode, [&](const openvdb::CoordBBox& cube) {
        if (const auto value = far.valueIn(cube)) return add(2, cube.min(), *value);
        openvdb::CoordBBox part = cube;
        part.intersect(box);
        forEachCube(part, DensityLeaf::DIM, [&](const openvdb::CoordBBox& block) {
            if (const auto value = far.valueIn(block)) add(1, block.min(), *value);
        });
    });
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
    joinPieces(std::move(pieces), far, static_cast<float>(options.threshold), leaves, constant);

    forEachChunk(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!finishLeaf(*leaves[i], options)) leaves[i].reset();
        }
    });

    // Hand the leaves to the tree in the order of their place, so that neighbours share a path.
    auto grid = openvdb::FloatGrid::create(0.0F);
    openvdb::FloatTree& tree = grid->tree();
    addFarTiles(far, options.clamp, tree);
    for (const ConstantBlock& block : constant) {
        const float value = options.clamp ? std::clamp(block.value, 0.0F, 1.0F) : block.value;
        if (value != 0) tree.addTile(1, block.origin, value, /*active=*/true);
    }
    for (std::unique_ptr<DensityLeaf>& leaf : leaves) {
        if (leaf) tree.addLeaf(leaf.release());
    }
    if (options.isPart) addBordersOfPart(far, options, tree);
    openvdb::tools::pruneTiles(tree, 0.0F, /*threaded=*/false);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(layout.voxelSize));
    return grid;
}

}  // namespace bandvox

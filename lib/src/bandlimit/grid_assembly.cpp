#include "bandlimit/grid_assembly.h"

#include <bandvox/core/parallel.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

namespace bandvox {

namespace {

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

void addTiles(const FarTiles& far, const std::vector<ConstantBlock>& constant, bool clamp,
              openvdb::FloatTree& tree) {
    addFarTiles(far, clamp, tree);
    addConstant(constant, clamp, tree);
}

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
    FarTiles far(layout);
    far.take(0, columns);
    columns.clear();
    finishLeaves(leaves, options);
    JoinedBlocks joined = joinPieces(std::move(pieces), far, options);
    constant.insert(constant.end(), joined.constant.begin(), joined.constant.end());

    auto grid = openvdb::FloatGrid::create(0.0F);
    openvdb::FloatTree& tree = grid->tree();
    addTiles(far, constant, options.clamp, tree);
    addLeaves(leaves, tree);
    addLeaves(joined.leaves, tree);
    if (options.isPart) addBordersOfPart(far, options, tree);
    openvdb::tools::pruneTiles(tree, 0.0F, /*threaded=*/false);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(layout.voxelSize));
    return grid;
}

}  // namespace bandvox

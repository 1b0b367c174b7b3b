#include "render/volume_blocks.h"

#include "render/examine_leaves.h"
#include "render/tile_shell.h"

#include <bandvox/core/memory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox {

namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

// Values of the lattice act on places this many voxels beyond them, farther off only as ripples,
// less than 0.004 of a step.
constexpr int kReach = 3;

// Densities below this part of the highest are nothing beside it.
constexpr float kNoDensity = 1e-5F;

// Averages do not rise, but for rounding.
constexpr double kAverageRise = 1.0001;

// What interpolation to a tolerance adds.
constexpr double kRiseMargin = 1.01;

constexpr float kLargest = 1e30F;

// Around tiles of so many blocks along a side or more, which are of the root, whole leaves are
// raised: they take no memory of their own, and beside so much a thicker shell costs lines of sight
// next to nothing.
constexpr int kRootTile =
    static_cast<int>(Tree::RootNodeType::ChildNodeType::DIM) / VolumeBlocks::kSide;

// What a leaf holds that matters to itself, 0, and to its neighbours before, -1, and behind, 1,
// along each axis: [x + 1][y + 1][z + 1].
struct LeafMaxima {
    std::array<float, 27> most;
    bool finite = true;
};

// Calls visit(neighbour) for all neighbours that a voxel matters to.
template <typename Visitor>
void forNeighbours(const openvdb::Coord& local, const Visitor& visit) {
    std::array<std::array<bool, 3>, 3> touches{};
    for (int axis = 0; axis < 3; ++axis) {
        touches[axis] = {local[axis] < kReach, true, local[axis] >= VolumeBlocks::kSide - kReach};
    }
    for (int x = 0; x < 3; ++x) {
        if (!touches[0][x]) continue;
        for (int y = 0; y < 3; ++y) {
            if (!touches[1][y]) continue;
            for (int z = 0; z < 3; ++z) {
                if (touches[2][z]) visit(9 * x + 3 * y + z);
            }
        }
    }
}

// How far above the nodes the density between them rises at most: as that of a point in the middle
// between eight of them. For a Gaussian, g(x) / g(x - h) is what a sum of such points obeys as
// well, as long as none is negative; for others it is what solids do not exceed.
double riseAboveNodes(const std::optional<ExponentialFilter>& filter) {
    if (!filter) return kAverageRise;
    constexpr int kFrequencies = 512;
    const double farthest = 0.5 * std::sqrt(3.0);
    double there = 0, atNodes = 0;
    for (int i = 0; i < kFrequencies; ++i) {
        const double k = 0.5 * (i + 0.5) / kFrequencies;
        const double turn = 2 * std::numbers::pi * k * farthest;
        const double weight = (*filter)(k)*k * k;
        there += weight;
        atNodes += weight * std::sin(turn) / turn;
    }
    return kRiseMargin * there / atNodes;
}

LeafMaxima findMaxima(const Leaf& leaf) {
    LeafMaxima found;
    found.most.fill(0);
    const float* values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const float value = values[i];
        found.finite = found.finite && std::abs(value) <= kLargest;
        if (!(value > 0)) continue;
        forNeighbours(Leaf::offsetToLocalCoord(i), [&](int neighbour) {
            found.most[neighbour] = std::max(found.most[neighbour], value);
        });
    }
    return found;
}

openvdb::Coord neighbourOf(const openvdb::Coord& block, int i) {
    return block.offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
}

}  // namespace

VolumeBlocks::VolumeBlocks(const openvdb::FloatGrid& grid,
                           const std::optional<ExponentialFilter>& filter, double least,
                           const Progress& progress)
    : mBlocks(0) {
    const auto rise = static_cast<float>(riseAboveNodes(filter));

    // Mark the tiles first, then around each of them: its borders matter to tiles beside it too.
    std::vector<Tile> tiles;
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        progress.throwIfInterrupted();
        const float value = tile.getValue();
        mFinite = mFinite && std::abs(value) <= kLargest;
        if (!(value > 0)) continue;
        openvdb::CoordBBox blocks = tile.getBoundingBox();
        blocks.min() >>= kLog2;
        blocks.max() >>= kLog2;
        mBlocks.sparseFill(blocks, rise * value, true);
        tiles.push_back({blocks, rise * value});
    }
    raiseAround(tiles, progress);

    // Examine the leaves, then mark in their order.
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const std::vector<LeafMaxima> found = examineLeaves(leaves, progress, findMaxima);
    float highest = 0;
    for (const Tile& marked : tiles) highest = std::max(highest, marked.most);
    for (const LeafMaxima& leaf : found) highest = std::max(highest, leaf.most[13]);
    const float nothing = std::min(kNoDensity * highest, static_cast<float>(least));
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        progress.throwIfInterrupted();
        mFinite = mFinite && found[i].finite;
        const openvdb::Coord block = leaves[i]->origin() >> kLog2;
        for (int n = 0; n < 27; ++n) {
            if (found[i].most[n] > nothing) raise(neighbourOf(block, n), rise * found[i].most[n]);
        }
    }
    mBox = boxOfBlocks(mBlocks);
}

void VolumeBlocks::raiseAround(const std::vector<Tile>& tiles, const Progress& progress) {
    const auto isRootTile = [](const Tile& tile) { return tile.blocks.dim()[0] >= kRootTile; };
    const auto covers = [](const Tile& tile) {
        return [most = tile.most](float value) { return value >= most; };
    };
    TileShells<Tree> shells(mBlocks, progress);
    for (const Tile& tile : tiles) {
        // Those no larger than leaves have their like in memory already.
        if (tile.blocks.dim()[0] == 1) continue;
        if (isRootTile(tile)) {
            shells.countNodes(tile.blocks, covers(tile));
        } else {
            shells.countLeaves(tile.blocks, covers(tile));
        }
    }
    const double bytes = shells.bytes(Leaf::SIZE * sizeof(float));
    if (bytes > 0) requireMemory(bytes, "the surface of the grid's tiles");

    for (const Tile& tile : tiles) {
        if (tile.blocks.dim()[0] == 1) {
            progress.throwIfInterrupted();
            for (int n = 0; n < 27; ++n) raise(neighbourOf(tile.blocks.min(), n), tile.most);
            continue;
        }
        shells.forEachPart(tile.blocks, covers(tile), [&](const openvdb::CoordBBox& part) {
            if (!isRootTile(tile)) {
                for (auto block = part.begin(); block; ++block) raise(*block, tile.most);
                return;
            }
            const openvdb::CoordBBox whole = openvdb::CoordBBox::createCube(
                part.min() & ~(int(Leaf::DIM) - 1), static_cast<int>(Leaf::DIM));
            if (mBlocks.probeLeaf(part.min())) {
                for (auto block = whole.begin(); block; ++block) raise(*block, tile.most);
            } else {
                mBlocks.addTile(1, whole.min(), tile.most, true);
            }
        });
    }
}

void VolumeBlocks::raise(const openvdb::Coord& block, float most) {
    float before = 0;
    if (mBlocks.probeValue(block, before) && before >= most) return;
    mBlocks.setValue(block, std::max(before, most));
}

}  // namespace bandvox

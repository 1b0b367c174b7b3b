#include "render/volume_blocks.h"

#include "render/examine_leaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// Values of the lattice act on places this many voxels beyond them, farther off only as ripples of
// what is left near Nyquist.
constexpr int kReach = 2;

// Densities below this stop no light to speak of.
constexpr float kNoDensity = 1e-4F;

// How far above the nodes the density between them rises: hardly where it is band-limited; by a
// quarter of a step at most under the cubic spline.
constexpr double kBandLimitedRise = 1.05;
constexpr double kSplineRise = 1.25;

constexpr float kLargest = 1e30F;

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
        touches[axis] = {local[axis] < kReach, true, local[axis] >= kBlockSide - kReach};
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

LeafMaxima findMaxima(const Leaf& leaf) {
    LeafMaxima found;
    found.most.fill(0);
    const float* values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const float value = values[i];
        found.finite = found.finite && std::abs(value) <= kLargest;
        if (!(value > found.most[13] || value > kNoDensity)) continue;
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

VolumeBlocks::VolumeBlocks(const openvdb::FloatGrid& grid, bool isBandLimited) : mBlocks(0) {
    const auto rise = static_cast<float>(isBandLimited ? kBandLimitedRise : kSplineRise);

    // Mark the tiles; the borders of each matter to the blocks around it.
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const float value = tile.getValue();
        mFinite = mFinite && std::abs(value) <= kLargest;
        if (!(value > kNoDensity)) continue;
        openvdb::CoordBBox blocks = tile.getBoundingBox();
        blocks.min() >>= kBlockLog2;
        blocks.max() >>= kBlockLog2;
        mBlocks.sparseFill(blocks, rise * value, true);
        openvdb::CoordBBox around = blocks;
        around.expand(1);
        for (auto block = around.begin(); block; ++block) {
            if (!blocks.isInside(*block)) raise(*block, rise * value);
        }
    }

    // Examine the leaves, then mark in their order.
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const std::vector<LeafMaxima> found = examineLeaves(leaves, findMaxima);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        mFinite = mFinite && found[i].finite;
        const openvdb::Coord block = leaves[i]->origin() >> kBlockLog2;
        for (int n = 0; n < 27; ++n) {
            if (found[i].most[n] > kNoDensity)
                raise(neighbourOf(block, n), rise * found[i].most[n]);
        }
    }
    mBox = boxOfBlocks(mBlocks);
}

void VolumeBlocks::raise(const openvdb::Coord& block, float most) {
    float before = 0;
    if (mBlocks.probeValue(block, before) && before >= most) return;
    mBlocks.setValue(block, std::max(before, most));
}

}  // namespace bandvox

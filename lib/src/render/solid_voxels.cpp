#include "render/solid_voxels.h"

#include "render/examine_leaves.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bandvox {

namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

struct SolidLeaf {
    Leaf::NodeMaskType solid;
    float maximum;
};

SolidLeaf findSolid(const Leaf& leaf, float iso) {
    SolidLeaf found{{}, leaf.getValue(0)};
    const float* values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        found.maximum = std::max(found.maximum, values[i]);
        if (values[i] >= iso) found.solid.setOn(i);
    }
    return found;
}

// A line of sight on its way from voxel to voxel. Voxel i is the interval [i, i + 1) of shifted
// coordinates. Places on the line are computed from its start each time, so errors do not add up.
class VoxelWalk {
  public:
    VoxelWalk(const Ray& ray, const openvdb::CoordBBox& box)
        : mOrigin(ray.origin + openvdb::Vec3d(0.5)), mDirection(ray.direction), mBox(box) {}

    const VoxelHit& at() const { return mAt; }

    // Goes to the first voxel of the box. False if the line misses it.
    bool enter() {
        double leaves = HUGE_VAL;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = mBox.min()[axis], high = double(mBox.max()[axis]) + 1;
            if (mDirection[axis] == 0) {
                if (!(mOrigin[axis] >= low && mOrigin[axis] < high)) return false;
                continue;
            }
            const bool rising = mDirection[axis] > 0;
            const double enters = timeAt(axis, rising ? low : high);
            leaves = std::min(leaves, timeAt(axis, rising ? high : low));
            if (enters > mAt.t) arrive(enters, axis);
        }
        if (mAt.t > leaves) return false;
        for (int axis = 0; axis < 3; ++axis) {
            mAt.voxel[axis] = voxelAt(axis, mBox.min()[axis], mBox.max()[axis]);
        }
        return true;
    }

    // Leaves the aligned cube of `side` voxels, a power of two, around the voxel. False if that
    // leads out of the box.
    bool pass(int side) {
        const Coord low(mAt.voxel.x() & -side, mAt.voxel.y() & -side, mAt.voxel.z() & -side);
        double leaves = HUGE_VAL;
        int across = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (mDirection[axis] == 0) continue;
            const double end = low[axis] + (mDirection[axis] > 0 ? double(side) : 0.0);
            const double t = timeAt(axis, end);
            if (t < leaves) {
                leaves = t;
                across = axis;
            }
        }
        arrive(std::max(leaves, mAt.t), across);
        for (int axis = 0; axis < 3; ++axis) {
            // Rounding leads neither out of the cube nor back.
            int least = low[axis], most = low[axis] + (side - 1);
            (mDirection[axis] > 0 ? least : most) = mAt.voxel[axis];
            if (axis == across) {
                mAt.voxel[axis] = mDirection[axis] > 0 ? most + 1 : least - 1;
            } else if (mDirection[axis] != 0) {
                mAt.voxel[axis] = voxelAt(axis, least, most);
            }
        }
        return mAt.voxel[across] >= mBox.min()[across] && mAt.voxel[across] <= mBox.max()[across];
    }

  private:
    double timeAt(int axis, double place) const {
        return (place - mOrigin[axis]) / mDirection[axis];
    }

    void arrive(double t, int axis) {
        mAt.t = t;
        mAt.axis = axis;
        mAt.side = mDirection[axis] > 0 ? -1 : 1;
    }

    int voxelAt(int axis, int least, int most) const {
        const double place = std::floor(mOrigin[axis] + mAt.t * mDirection[axis]);
        return static_cast<int>(std::clamp(place, double(least), double(most)));
    }

    openvdb::Vec3d mOrigin, mDirection;
    const openvdb::CoordBBox& mBox;
    VoxelHit mAt;
};

// The side of the largest empty node around a voxel that is not solid.
int emptySide(const SolidVoxels::Probe& probe, const Coord& voxel) {
    using Root = openvdb::MaskTree::RootNodeType;
    using Upper = Root::ChildNodeType;
    using Lower = Upper::ChildNodeType;
    switch (probe.getValueDepth(voxel)) {
        case 3:
            return 1;
        case 2:
            return Lower::ChildNodeType::DIM;
        case 1:
            return Lower::DIM;
        default:
            return Upper::DIM;
    }
}

}  // namespace

SolidVoxels::SolidVoxels(const openvdb::FloatGrid& grid, double iso, const Progress& progress)
    : mMaximum(grid.background()) {
    // Examine the leaves, then take over those with solid voxels, in their order.
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const auto limit = static_cast<float>(iso);
    const std::vector<SolidLeaf> found = examineLeaves(
        leaves, progress, [limit](const Leaf& leaf) { return findSolid(leaf, limit); });
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        progress.throwIfInterrupted();
        mMaximum = std::max<double>(mMaximum, found[i].maximum);
        if (!found[i].solid.isOff()) {
            mSolid.touchLeaf(leaves[i]->origin())->setValueMask(found[i].solid);
        }
    }

    // Take over the tiles, active or not.
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        progress.throwIfInterrupted();
        if (!(tile.getValue() >= limit)) continue;
        mMaximum = std::max<double>(mMaximum, tile.getValue());
        mSolid.sparseFill(tile.getBoundingBox(), true, true);
    }
    mSolid.evalActiveVoxelBoundingBox(mBox);
}

std::optional<VoxelHit> SolidVoxels::firstHit(const Ray& ray, const Probe& probe) const {
    VoxelWalk walk(ray, mBox);
    if (empty() || !walk.enter()) return std::nullopt;
    do {
        if (probe.isValueOn(walk.at().voxel)) return walk.at();
    } while (walk.pass(emptySide(probe, walk.at().voxel)));
    return std::nullopt;
}

}  // namespace bandvox

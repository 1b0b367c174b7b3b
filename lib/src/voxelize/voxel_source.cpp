#include <bandvox/core/error.h>
#include <bandvox/voxelize/voxel_source.h>

#include <cmath>
#include <sstream>
#include <utility>

namespace bandvox {

namespace {

using GridTree = openvdb::FloatTree;
// One that the tree does not keep a list of, which would cost each row a lock.
using RowAccessor = openvdb::tree::ValueAccessor<const GridTree, false>;

constexpr double kHalf = 0.5;
constexpr double kFarthest = 1 << 30;  // indices beyond hold nothing
constexpr int kMostNodes = 4096;       // that one box is looked up in

int nearestVoxel(double x) {
    // Written so that a NaN is far away, too.
    if (!(x > -kFarthest)) return -(1 << 30);
    return static_cast<int>(std::floor(std::min(x, kFarthest) + kHalf));
}

openvdb::Coord nearestVoxel(const openvdb::Vec3d& p) {
    return {nearestVoxel(p.x()), nearestVoxel(p.y()), nearestVoxel(p.z())};
}

// Looks whether all voxels of boxes have one value, node by node.
class ConstantBox {
  public:
    ConstantBox(const GridTree& tree, const openvdb::Coord& first)
        : mAccessor(tree), mValue(mAccessor.getValue(first)) {}

    float value() const { return mValue; }

    bool holds(const openvdb::CoordBBox& box) {
        if (++mNodes > kMostNodes) return false;
        // Split off what the node at the first corner covers, until it is all.
        const openvdb::Coord first = box.min();
        const int side = sideOfNode(first);
        openvdb::CoordBBox node(first & ~(side - 1), first | (side - 1));
        openvdb::CoordBBox rest = box;
        for (int axis = 0; axis < 3; ++axis) {
            if (rest.max()[axis] <= node.max()[axis]) continue;
            openvdb::CoordBBox beyond = rest;
            beyond.min()[axis] = node.max()[axis] + 1;
            rest.max()[axis] = node.max()[axis];
            if (!holds(beyond)) return false;
        }
        return side == kLeafSide ? holdsInLeaf(rest) : mAccessor.getValue(first) == mValue;
    }

  private:
    static constexpr int kLeafSide = GridTree::LeafNodeType::DIM;

    // The side of the tile, or of the leaf node, that a voxel lies in.
    int sideOfNode(const openvdb::Coord& voxel) const {
        using Upper = GridTree::RootNodeType::ChildNodeType;
        switch (mAccessor.getValueDepth(voxel)) {
            case -1:
            case 0:
                return Upper::DIM;
            case 1:
                return Upper::ChildNodeType::DIM;
            default:
                return kLeafSide;
        }
    }

    bool holdsInLeaf(const openvdb::CoordBBox& box) const {
        for (auto voxel = box.begin(); voxel; ++voxel) {
            if (mAccessor.getValue(*voxel) != mValue) return false;
        }
        return true;
    }

    RowAccessor mAccessor;
    float mValue;
    int mNodes = 0;
};

[[noreturn]] void refuse(const std::string& name, const std::string& found,
                         const std::string& expected) {
    throw Error(ErrorKind::Input, name + ": " + found + "; expected " + expected);
}

}  // namespace

VoxelSource::VoxelSource(std::string name, openvdb::FloatGrid::ConstPtr grid)
    : mName(std::move(name)), mGrid(std::move(grid)) {
    if (!mGrid->transform().isLinear()) {
        refuse(mName, "the grid's transform is not linear", "voxels that are all alike");
    }
    if (mGrid->background() != 0) {
        std::ostringstream found;
        found << "the grid's background is " << mGrid->background();
        refuse(mName, found.str(), "0");
    }
    const openvdb::CoordBBox active = mGrid->evalActiveVoxelBoundingBox();
    if (active.empty()) refuse(mName, "no voxel of the grid is active", "at least one");
    mBounds = mGrid->transform().indexToWorld(
        openvdb::BBoxd(active.min().asVec3d() - openvdb::Vec3d(kHalf),
                       active.max().asVec3d() + openvdb::Vec3d(kHalf)));
}

std::optional<float> VoxelSource::constantIn(const openvdb::BBoxd& box) const {
    const openvdb::BBoxd indices = mGrid->transform().worldToIndex(box);
    const openvdb::CoordBBox voxels(nearestVoxel(indices.min()), nearestVoxel(indices.max()));
    if (voxels.empty()) return std::nullopt;
    ConstantBox constant(mGrid->tree(), voxels.min());
    if (!constant.holds(voxels)) return std::nullopt;
    return constant.value();
}

void VoxelSource::sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                            std::span<float> values) const {
    const openvdb::Vec3d first = mGrid->worldToIndex(start);
    const openvdb::Vec3d stride = mGrid->worldToIndex(start + step) - first;
    const RowAccessor accessor(mGrid->tree());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = accessor.getValue(nearestVoxel(first + static_cast<double>(i) * stride));
    }
}

}  // namespace bandvox

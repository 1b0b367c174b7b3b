#include "grid/joint_reader.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bandvox {

namespace {

using JointTree = openvdb::FloatTree;

constexpr int kRootSide = 4096;
constexpr int kMiddleSide = 128;
constexpr int kBlockSide = JointReader::Leaf::DIM;

// The side of the tile or voxel that holds a value at a depth of the tree; -1 is the background.
int sideAtDepth(int depth) {
    constexpr int kSides[] = {std::numeric_limits<int>::max(), kRootSide, kMiddleSide, kBlockSide,
                              1};
    return kSides[depth + 1];
}

[[noreturn]] void failJointNotFinite(const openvdb::FloatGrid& grid) {
    throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                      "\" holds values that are not finite; expected numbers");
}

// Calls visit(origin) for each cube of a side that meets the box of that side from `first` on.
template <typename Visit>
void visitCubes(const openvdb::Coord& first, int side, const Visit& visit) {
    const openvdb::Coord begin = first & ~(side - 1);
    // Along each axis there are two, or one if the box is one of them; counted, as the ends of the
    // last ones may be more than an index holds.
    int counts[3];
    for (int axis = 0; axis < 3; ++axis) counts[axis] = first[axis] == begin[axis] ? 1 : 2;
    for (int x = 0; x < counts[0]; ++x) {
        for (int y = 0; y < counts[1]; ++y) {
            for (int z = 0; z < counts[2]; ++z) {
                visit(begin.offsetBy(x * side, y * side, z * side));
            }
        }
    }
}

std::vector<openvdb::Coord> rootCubes(const std::vector<JointGrid>& grids) {
    std::vector<openvdb::Coord> cubes;
    for (const JointGrid& joint : grids) {
        const auto add = [&](const openvdb::Coord& origin) {
            visitCubes(origin - joint.offset, kRootSide,
                       [&cubes](const openvdb::Coord& at) { cubes.push_back(at); });
        };
        using RootChild = JointTree::RootNodeType::ChildNodeType;
        std::vector<const RootChild*> children;
        joint.grid->tree().getNodes(children);
        for (const RootChild* child : children) add(child->origin());
        auto tile = joint.grid->cbeginValueAll();
        tile.setMaxDepth(0);
        for (; tile; ++tile) add(tile.getCoord());
    }
    std::sort(cubes.begin(), cubes.end());
    cubes.erase(std::unique(cubes.begin(), cubes.end()), cubes.end());
    return cubes;
}

enum class CubeContent { Nothing, Constants, Mixed };

CubeContent contentOf(const JointReader& reader, const std::vector<JointGrid>& grids,
                      const JointCube& cube) {
    CubeContent content = CubeContent::Nothing;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const auto constant = reader.constantIn(i, cube);
        if (!constant) return CubeContent::Mixed;
        if (constant->active || constant->value != grids[i].grid->background()) {
            content = CubeContent::Constants;
        }
    }
    return content;
}

}  // namespace

JointReader::JointReader(const std::vector<JointGrid>& grids) {
    mEntries.reserve(grids.size());
    for (const JointGrid& joint : grids) {
        mEntries.push_back(
            {joint.grid, joint.offset,
             openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>(joint.grid->tree())});
    }
}

std::optional<ConstantCube> JointReader::constantIn(std::size_t grid, const JointCube& cube) const {
    const Entry& entry = mEntries[grid];
    std::optional<ConstantCube> found;
    bool isConstant = true;
    visitCubes(cube.origin + entry.offset, cube.side, [&](const openvdb::Coord& at) {
        if (!isConstant) return;
        if (sideAtDepth(entry.accessor.getValueDepth(at)) < cube.side) {
            isConstant = false;
            return;
        }
        const ConstantCube here{entry.accessor.getValue(at), entry.accessor.isValueOn(at)};
        if (!std::isfinite(here.value)) failJointNotFinite(*entry.grid);
        isConstant = !found || (found->value == here.value && found->active == here.active);
        found = here;
    });
    return isConstant ? found : std::nullopt;
}

void JointReader::readBlock(std::size_t grid, const openvdb::Coord& origin, float* values,
                            Leaf::NodeMaskType& active) const {
    const Entry& entry = mEntries[grid];
    const openvdb::Coord first = origin + entry.offset;
    if ((first & (kBlockSide - 1)) != openvdb::Coord(0)) {
        for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
            const openvdb::Coord at = first + Leaf::offsetToLocalCoord(i);
            values[i] = entry.accessor.getValue(at);
            active.set(i, entry.accessor.isValueOn(at));
        }
    } else if (const Leaf* leaf = entry.accessor.probeConstLeaf(first)) {
        std::copy_n(leaf->buffer().data(), Leaf::SIZE, values);
        active = leaf->getValueMask();
    } else {
        std::fill_n(values, Leaf::SIZE, entry.accessor.getValue(first));
        active.set(entry.accessor.isValueOn(first));
    }
    const bool isFinite =
        std::all_of(values, values + Leaf::SIZE, [](float v) { return std::isfinite(v); });
    if (!isFinite) failJointNotFinite(*entry.grid);
}

std::vector<JointCube> jointCubes(const std::vector<JointGrid>& grids) {
    const JointReader reader(grids);
    std::vector<JointCube> cubes;
    for (const openvdb::Coord& origin : rootCubes(grids)) {
        const JointCube root{origin, kRootSide};
        const CubeContent content = contentOf(reader, grids, root);
        if (content == CubeContent::Constants) cubes.push_back(root);
        if (content != CubeContent::Mixed) continue;
        openvdb::Coord at;
        const openvdb::Coord end = origin.offsetBy(kRootSide);
        for (at[0] = origin[0]; at[0] < end[0]; at[0] += kMiddleSide) {
            for (at[1] = origin[1]; at[1] < end[1]; at[1] += kMiddleSide) {
                for (at[2] = origin[2]; at[2] < end[2]; at[2] += kMiddleSide) {
                    const JointCube cube{at, kMiddleSide};
                    if (contentOf(reader, grids, cube) != CubeContent::Nothing) {
                        cubes.push_back(cube);
                    }
                }
            }
        }
    }
    return cubes;
}

}  // namespace bandvox

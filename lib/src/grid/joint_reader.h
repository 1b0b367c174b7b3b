#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <optional>
#include <vector>

namespace bandvox {

/// A grid among others on one lattice: voxel x of the lattice is its voxel x + offset.
struct JointGrid {
    const openvdb::FloatGrid* grid;
    openvdb::Coord offset;
};

/// A value that is the same in all of a cube, and whether its voxels are active.
struct ConstantCube {
    float value;
    bool active;
};

/// A cube of voxels of the lattice; its first voxel is a multiple of its side, which is that of a
/// node of a tree: 4096, 128 or 8.
struct JointCube {
    openvdb::Coord origin;
    int side;
};

/// Reads several grids of one lattice cube by cube, whatever their nodes; one for each thread.
class JointReader {
  public:
    using Leaf = openvdb::FloatTree::LeafNodeType;

    explicit JointReader(const std::vector<JointGrid>& grids);

    /// What a grid is in all of a cube; nothing if finding that out would take a look at smaller
    /// cubes. Throws Error(ErrorKind::Input) if it is not finite.
    std::optional<ConstantCube> constantIn(std::size_t grid, const JointCube& cube) const;

    /// The values of a grid in a cube of 8³ voxels, in a leaf's order, and which are active. Throws
    /// Error(ErrorKind::Input) if one is not finite.
    void readBlock(std::size_t grid, const openvdb::Coord& origin, float* values,
                   Leaf::NodeMaskType& active) const;

  private:
    struct Entry {
        const openvdb::FloatGrid* grid;
        openvdb::Coord offset;
        openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> accessor;
    };
    std::vector<Entry> mEntries;
};

/// The cubes of side 128 or 4096 that hold all in which a grid differs from its background or is
/// active, in order of their places. Those of side 4096 are constant in every grid.
std::vector<JointCube> jointCubes(const std::vector<JointGrid>& grids);

}  // namespace bandvox

#pragma once

#include <openvdb/openvdb.h>

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace bandvox {

/// How the values of a new lattice are stored.
struct StorageRule {
    float background;
    float threshold;             ///< values nearer to the background are stored as it, inactive
    std::vector<float> anchors;  ///< other values that are stored as such if they are as near
    bool wholeNumbers;           ///< so are whole numbers

    float stored(float value) const;
};

/// A part of a new grid: leaves, and tiles as large as leaves.
class GridPart {
  public:
    /// Takes the values of a cube of voxels, z fastest; its first voxel and its side are multiples
    /// of 8.
    void addCube(const openvdb::Coord& origin, int side, std::span<const float> values,
                 const StorageRule& rule);
    /// The same for a cube of equal values.
    void addConstant(const openvdb::Coord& origin, int side, float value, bool active);

    float minimum() const { return mMinimum; }
    float maximum() const { return mMaximum; }

    /// Hands all over to a tree, which has nothing there yet.
    void moveTo(openvdb::FloatTree& tree);

  private:
    using Leaf = openvdb::FloatTree::LeafNodeType;
    struct Tile {
        openvdb::Coord origin;
        float value;
        bool active;
    };

    void note(float value);

    std::vector<std::unique_ptr<Leaf>> mLeaves;
    std::vector<Tile> mTiles;
    float mMinimum = std::numeric_limits<float>::max();
    float mMaximum = std::numeric_limits<float>::lowest();
};

}  // namespace bandvox

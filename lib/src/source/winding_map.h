#pragma once

#include "source/winding_tree.h"

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// Cubes that fill a box, world units.
struct CellLattice {
    openvdb::Vec3d origin;  ///< corner of the first
    double side = 1;
    openvdb::Coord count;  ///< along each axis

    std::size_t index(const openvdb::Coord& cell) const {
        return (static_cast<std::size_t>(cell.x()) * count.y() + cell.y()) * count.z() + cell.z();
    }
};

/// Where a surface with openings winds around, by more than half: cell by cell.
class WindingMap {
  public:
    enum class State : std::uint8_t {
        Outside,  ///< all of the cell
        Inside,   ///< all of the cell
        Mixed     ///< it has triangles in it, or is too near an opening to tell
    };

    /// The winding number of what is inside is above this. On the two sides of a sheet that
    /// encloses nothing it comes up to 0.5, and all that is computed is off a little.
    static constexpr double kInside = 0.51;

    /// So far away groups of triangles are taken together (WindingTree::collect). What that is
    /// wrong by shifts an opening a little, and nothing else.
    static constexpr double kFarAway = 2;

    /// Throws Error(ErrorKind::Memory) before allocating if it would not fit,
    /// Error(ErrorKind::Interrupted).
    WindingMap(const WindingTree& tree, const CellLattice& cells, Progress& progress);

    const CellLattice& cells() const { return mCells; }
    State state(const openvdb::Coord& cell) const { return mState[mCells.index(cell)]; }
    /// About the winding number there, if it is not mixed.
    float winding(const openvdb::Coord& cell) const { return mWinding[mCells.index(cell)]; }

  private:
    struct Block;
    void divide(const Block& block, WindingTerms& terms);
    void fill(const Block& block, State state, double winding);

    const WindingTree& mTree;
    CellLattice mCells;
    std::vector<State> mState;
    std::vector<float> mWinding;
};

}  // namespace bandvox

#pragma once

#include "resample/block_filter.h"

#include <openvdb/openvdb.h>

#include <optional>
#include <vector>

namespace bandvox {

/// The lowest and the highest value of a grid, background included.
struct ValueRange {
    float low, high;
};

/// Throws Error(ErrorKind::Input) if a value is not finite.
ValueRange finiteRange(const openvdb::FloatGrid& grid);

/// A value that is the same in all of a box, and whether its voxels are active.
struct ConstantRegion {
    float value;
    bool active;
};

/// Reads a grid for the blocks of another lattice; one for each thread.
class SourceReader {
  public:
    explicit SourceReader(const openvdb::FloatGrid& grid) : mAccessor(grid.tree()) {}

    /// What the grid is in all of a box, if that is cheap to know.
    std::optional<ConstantRegion> constantIn(const openvdb::CoordBBox& box) const;

    /// Copies the cube that a block is made of.
    void copy(const SourceCube& cube, float* to) const;

  private:
    openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> mAccessor;
};

/// The blocks of the target in which something may differ from the background, in their order.
/// Throws Error(ErrorKind::Memory) if they are too many to be listed.
std::vector<openvdb::Coord> blocksNear(const openvdb::FloatGrid& grid, const LatticeMap& map,
                                       const BlockFilter& filter);

}  // namespace bandvox

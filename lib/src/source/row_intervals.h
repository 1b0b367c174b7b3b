#pragma once

#include "source/box_tree.h"

#include <bandvox/source/mesh.h>

#include <span>
#include <vector>

namespace bandvox {

/// Where lines along x run inside of a closed mesh.
class RowIntervals {
  public:
    /// A line's place in the world, and the scale of places along it.
    struct Line {
        double y, z;       ///< world units
        double xOrigin;    ///< of places along it, voxels
        double voxelSize;  ///< world units
    };

    /// Keeps a reference to the mesh.
    explicit RowIntervals(const Mesh& mesh);

    /// Appends to `rest` what the mesh leaves of a line's intervals: begin, end, begin, end, …
    void subtractFrom(std::span<const float> intervals, const Line& line,
                      std::vector<float>& rest) const;

  private:
    const Mesh& mMesh;
    BoxTree mTree;
};

}  // namespace bandvox

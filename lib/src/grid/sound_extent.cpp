#include "grid/sound_extent.h"

#include <sstream>

namespace bandvox {

std::string extentFault(const openvdb::GridBase& grid) {
    constexpr int kFarthest = 1 << 30;
    openvdb::CoordBBox box;
    if (!grid.baseTree().evalLeafBoundingBox(box)) return {};
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min()[axis] >= -kFarthest && box.max()[axis] <= kFarthest) continue;
        std::ostringstream fault;
        fault << "has active voxels in a box from " << box.min() << " to " << box.max()
              << "; expected none beyond 2^30 voxels from voxel 0";
        return fault.str();
    }
    return {};
}

}  // namespace bandvox

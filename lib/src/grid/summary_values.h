#pragma once

#include <bandvox/core/error.h>

#include <openvdb/openvdb.h>

#include <cmath>
#include <string>

// What the summaries of a grid have in common.
namespace bandvox {

/// A value as summaries count it.
inline float finiteOr(float value, float fallback) {
    return std::isfinite(value) ? value : fallback;
}

/// The background as summaries count it.
inline float finiteBackground(const openvdb::FloatGrid& grid) {
    return finiteOr(grid.background(), 0.0F);
}

/// The box of active voxels. Throws Error(ErrorKind::Result) if there is none.
inline openvdb::CoordBBox requireActiveBox(const openvdb::FloatGrid& grid) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) {
        throw Error(ErrorKind::Result,
                    "the grid '" + grid.getName() + "' has no active voxel; expected at least one");
    }
    return box;
}

}  // namespace bandvox

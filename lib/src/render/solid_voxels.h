#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <optional>

namespace bandvox {

/// Where a line of sight meets a solid voxel: on one of its faces.
struct VoxelHit {
    double t = 0;          ///< along the ray, in lengths of its direction
    openvdb::Coord voxel;  ///< the solid one
    int axis = -1;         ///< that the face is across; -1 if the ray starts inside
    int side = 0;          ///< of the voxel on which the face is: -1 or 1
};

/// The voxels of a grid that are solid, cubes around their centres. All in index coordinates.
class SolidVoxels {
  public:
    /// Solid is what has a value ≥ iso, which must be above the grid's background. Throws
    /// Error(ErrorKind::Interrupted) if the caller wants to stop.
    SolidVoxels(const openvdb::FloatGrid& grid, double iso,
                const Progress& progress = silentProgress());

    bool empty() const { return mSolid.empty(); }

    /// The largest value of the grid.
    double maximum() const { return mMaximum; }

    /// Tells of a voxel whether it is solid. Each thread needs its own.
    using Probe = openvdb::tree::ValueAccessor<const openvdb::MaskTree, false>;
    Probe probe() const { return Probe(mSolid); }

    /// The first solid voxel on origin + t·direction, t ≥ 0, whose cubes are followed one by one;
    /// nodes without any are passed at once. `direction` may have any length but 0.
    std::optional<VoxelHit> firstHit(const Ray& ray, const Probe& probe) const;

  private:
    openvdb::MaskTree mSolid;
    openvdb::CoordBBox mBox;  // of the solid voxels, or a little more
    double mMaximum;
};

}  // namespace bandvox

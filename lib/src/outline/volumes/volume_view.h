#pragma once

#include "outline/drawing/view_matrix.h"

#include <openvdb/Types.h>
#include <openvdb/math/Mat4.h>

#include <array>

namespace bandvox {

/// A lattice as the page sees it: places and directions in index coordinates.
class VolumeView {
  public:
    /// `middle`: a place before the eye, index coordinates.
    VolumeView(const ViewMatrix& view, const openvdb::Mat4d& indexToWorld,
               const openvdb::Vec3d& middle);

    /// Where a place is seen: on the page, and its depth.
    openvdb::Vec3d place(const openvdb::Vec3d& index) const;

    /// The place that is seen there.
    openvdb::Vec3d placeOf(const openvdb::Vec3d& seen) const;

    /// The direction of sight at a place, away from the eye, of length 1 at the middle. It is
    /// linear: sight(p) = sight(0) + spread() p.
    openvdb::Vec3d sight(const openvdb::Vec3d& index) const { return mSpread * index + mSight; }
    double spread() const { return mSpread; }

    /// How the page sees a move from a place, by lengths of that.
    std::array<double, 2> move(const openvdb::Vec3d& index, const openvdb::Vec3d& by) const;

    /// Where the line of sight to a place begins: the eye, or a place that is `far` voxels nearer
    /// if lines of sight are parallel.
    openvdb::Vec3d start(const openvdb::Vec3d& index, double far) const;

  private:
    ViewMatrix mRows;  // of index coordinates
    openvdb::Mat4d mBack;
    openvdb::Vec3d mSight{0, 0, 0};
    double mSpread = 0;  // 0: lines of sight are parallel
};

}  // namespace bandvox

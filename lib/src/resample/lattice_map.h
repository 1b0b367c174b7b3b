#pragma once

#include <openvdb/openvdb.h>

namespace bandvox {

/// Where the voxels of one lattice lie in another, and what that does to frequencies:
/// x = A y + b takes places in target voxels to places in source voxels.
class LatticeMap {
  public:
    /// Both linear.
    LatticeMap(const openvdb::math::Transform& source, const openvdb::math::Transform& target);

    openvdb::Vec3d toSource(const openvdb::Vec3d& target) const {
        return mToSource.transform(target);
    }
    /// The box of a box's places.
    openvdb::BBoxd toSource(const openvdb::BBoxd& target) const;
    openvdb::BBoxd toTarget(const openvdb::BBoxd& source) const;

    /// |Aᵀk| in cycles per target voxel, of a frequency in cycles per source voxel; along
    /// directions in which the target's voxels are smaller than the source's, |k|.
    double frequency(const openvdb::Vec3d& k) const;

    /// The largest and the smallest step of the target's lattice, in source voxels, not less than
    /// 1: the factors by which frequencies rise.
    double coarsest() const { return mCoarsest; }
    double finest() const { return mFinest; }
    /// The largest step without the limit.
    double largestStep() const { return mLargestStep; }

    /// True if voxels lie on voxels.
    bool isAligned() const { return mIsAligned; }
    /// True if axes lie on axes of the same name.
    bool isDiagonal() const { return mIsDiagonal; }

  private:
    openvdb::Mat4d mToSource, mToTarget;
    openvdb::Mat3d mSquare;  // kᵀ mSquare k = frequency²
    double mCoarsest, mFinest, mLargestStep;
    bool mIsAligned, mIsDiagonal;
};

}  // namespace bandvox

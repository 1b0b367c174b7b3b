#pragma once

#include <bandvox/core/error.h>
#include <bandvox/source/boundary_source.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace bandvox {

/// Throws Error(ErrorKind::Usage) unless the largest element allowed, in voxels, is a length
/// that splitting reaches before it exhausts time and memory.
inline void requireUsefulLength(double length, const char* what) {
    constexpr double kShortest = 1e-3;
    if (length >= kShortest) return;
    throw Error(ErrorKind::Usage, std::string("the longest ") + what + " allowed is " +
                                      std::to_string(length) + " voxels; expected at least 0.001");
}

/// Keeps the surface samples that lie in a sampling region. All lengths in voxels.
class RegionClip {
  public:
    explicit RegionClip(const SamplingRegion& region)
        : mLower(region.origin), mUpper(region.origin + region.extent) {
        // A rounded point may lie outside the box of what it was computed from, by some units
        // in the last place; 1e-12 of a coordinate is thousands of them.
        for (int axis = 0; axis < 3; ++axis) {
            const double slack =
                1e-12 * std::max({1.0, std::abs(mLower[axis]), std::abs(mUpper[axis])});
            mCullLower[axis] = mLower[axis] - slack;
            mCullUpper[axis] = mUpper[axis] + slack;
        }
    }

    /// True if no point of the box can lie in the region.
    bool misses(const openvdb::Vec3d& lower, const openvdb::Vec3d& upper) const {
        return upper[0] < mCullLower[0] || lower[0] > mCullUpper[0] || upper[1] < mCullLower[1] ||
               lower[1] > mCullUpper[1] || upper[2] < mCullLower[2] || lower[2] > mCullUpper[2];
    }

    /// True if the position lies in the region, far faces excluded.
    bool holds(const openvdb::Vec3d& position) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(position[axis] >= mLower[axis] && position[axis] < mUpper[axis])) return false;
        }
        return true;
    }

    /// Appends the sample if the region holds its position.
    void append(const openvdb::Vec3d& position, const openvdb::Vec3d& areaVector,
                std::vector<SurfaceSample>& samples) const {
        if (!holds(position)) return;
        samples.push_back({openvdb::Vec3f(position - mLower), openvdb::Vec3f(areaVector)});
    }

  private:
    openvdb::Vec3d mLower, mUpper;
    openvdb::Vec3d mCullLower, mCullUpper;
};

}  // namespace bandvox

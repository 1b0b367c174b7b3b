#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>

namespace bandvox {

struct SplineVolumeParts;

/// Values in space as tensor products of uniform cubic B-splines, whose control points are where
/// there are data; twice continuously differentiable. Immutable by many threads at once.
class SplineVolume {
  public:
    SplineVolume() = default;
    explicit SplineVolume(std::shared_ptr<const SplineVolumeParts> parts)
        : mParts(std::move(parts)) {}

    int columns() const;
    /// The box of the points, world units.
    openvdb::BBoxd bounds() const;
    /// How far from a point there are values, world units.
    double reach() const;
    /// Control points of all nets.
    std::size_t controlPoints() const;

    /// True if there is a point within reach of a place, world units.
    bool covers(const openvdb::Vec3d& place) const;

    /// The value at a place, world units. What it is where no point is within reach is not said.
    double value(const openvdb::Vec3d& place, int column = 0) const;

    /// The gradient there, per world unit.
    openvdb::Vec3d gradient(const openvdb::Vec3d& place, int column = 0) const;

    const SplineVolumeParts& parts() const { return *mParts; }

  private:
    std::shared_ptr<const SplineVolumeParts> mParts;
};

}  // namespace bandvox

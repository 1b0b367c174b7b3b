#pragma once

#include "source/winding_moments.h"

#include <openvdb/Types.h>

#include <array>
#include <vector>

namespace bandvox {

/// The terms of a winding number for places near each other: triangles by their solid angles, and
/// groups of them far away by their moments. In single precision about an origin among the places.
class WindingTerms {
  public:
    /// Empties the list. `unit`: a length of which the places are a few away from the origin, world
    /// units.
    void begin(const openvdb::Vec3d& origin, double unit);

    void addTriangle(const std::array<openvdb::Vec3d, 3>& corner);
    /// `coefficients` are for lengths in units of `scale`, world units.
    void addGroup(const openvdb::Vec3d& center, const WindingMoments::Coefficients& coefficients,
                  double scale);
    /// To be called when all are there.
    void finish();

    /// The sum of all terms.
    double at(const openvdb::Vec3d& place) const;

  private:
    static constexpr int kTriangleNumbers = 9;
    static constexpr int kGroupNumbers = 3 + WindingMoments::kCoefficients;

    // Terms stand in blocks of kLanes, each a table of one number after the other.
    openvdb::Vec3d mOrigin{0.0};
    double mPerUnit = 1;
    std::vector<float> mTriangles, mGroups;
    int mTriangleCount = 0, mGroupCount = 0;
};

}  // namespace bandvox

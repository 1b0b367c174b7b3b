#pragma once

#include <bandvox/render/camera.h>
#include <bandvox/render/scene.h>

#include <openvdb/Types.h>

#include <vector>

namespace bandvox {

/// A place on a lamp, as seen from a place that it may shine on.
struct LampSample {
    openvdb::Vec3d direction;  ///< towards it, unit
    double distance;           ///< world units; infinite of directional ones
    openvdb::Vec3d color;      ///< what a white matt surface across the direction looks like
};

/// The lamps of a scene in the world.
class Lamps {
  public:
    Lamps(const std::vector<Light>& lights, const Camera& camera);

    int count() const { return static_cast<int>(mLights.size()); }

    /// `u`: in the unit square, chooses the place on lamp i.
    LampSample sample(int i, const openvdb::Vec3d& place, const openvdb::Vec2d& u) const;

    /// What a ray that leaves the scene sees of the disks of directional lamps.
    openvdb::Vec3d seenAlong(const openvdb::Vec3d& direction) const;

  private:
    std::vector<Light> mLights;  // places in the world, directions of length 1
};

}  // namespace bandvox

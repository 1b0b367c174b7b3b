#pragma once

#include "render/environment.h"
#include "render/lamps.h"
#include "render/screen_cells.h"
#include "render/surface_object.h"
#include "render/volume_object.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bandvox {

/// What reads a scene's grids, for one thread.
struct SceneProbes {
    std::vector<std::unique_ptr<DensityProbe>> surfaces;
    std::vector<VolumeProbe> volumes;
};

/// The glass that a ray is in, the innermost last.
class InsideOf {
  public:
    bool contains(int surface) const;
    bool empty() const { return mCount == 0; }
    std::span<const std::int8_t> surfaces() const { return {mSurfaces.data(), mCount}; }
    /// Not more than so many at a time; what comes then is not gone into.
    bool isFull() const { return mCount == mSurfaces.size(); }
    InsideOf with(int surface) const;
    InsideOf without(int surface) const;

  private:
    std::array<std::int8_t, 8> mSurfaces{};
    std::size_t mCount = 0;
};

/// The first surface on a ray.
struct NearestSurface {
    int surface;
    SurfaceHit hit;
    bool leaving;  ///< its glass, from inside
};

/// The objects of a scene, ready for lines of sight from many threads.
class PreparedScene {
  public:
    /// Throws as sceneToImage.
    PreparedScene(const Scene& scene, const PictureOptions& options, Progress& progress);

    const std::vector<std::unique_ptr<SurfaceObject>>& surfaces() const { return mSurfaces; }
    const std::vector<std::unique_ptr<VolumeObject>>& volumes() const { return mVolumes; }
    const Environment& environment() const { return mEnvironment; }

    /// Which objects have no value that is seen, in words.
    std::string whyEmpty() const;

    /// The light from around that comes from a direction.
    openvdb::Vec3d environmentAlong(const openvdb::Vec3d& direction) const;

    /// What a white matt surface of this normal sends out of the light from around, if nothing is
    /// in the way.
    openvdb::Vec3d environmentOn(const openvdb::Vec3d& normal) const;

    SceneProbes probes() const;

    /// The first surface on a ray, 0 ≤ t ≤ `end`. `spans`: for each surface the part of the ray in
    /// which it can be; none if that is not known.
    std::optional<NearestSurface> nearest(const Ray& ray, double end, const InsideOf& inside,
                                          SceneProbes& probes,
                                          std::span<const ScreenCells::Span> spans = {}) const;

    /// The glass that a place is in.
    InsideOf glassAround(const openvdb::Vec3d& place, SceneProbes& probes) const;

    /// The part of light that surfaces let through along a ray up to `end`, by colour. Glass does
    /// not bend it here.
    openvdb::Vec3d passing(const Ray& ray, double end, const InsideOf& inside,
                           SceneProbes& probes) const;

    /// What is left of light after a length of an object's glass.
    openvdb::Vec3d tint(int surface, double length) const;

  private:
    openvdb::Vec3d passing(int surface, const Ray& ray, double end, bool inside,
                           DensityProbe& probe) const;

    std::vector<std::unique_ptr<SurfaceObject>> mSurfaces;
    std::vector<std::unique_ptr<VolumeObject>> mVolumes;
    Environment mEnvironment;
};

}  // namespace bandvox

#pragma once

#include "render/lamps.h"
#include "render/medium_light.h"
#include "render/prepared_scene.h"
#include "render/scene_pieces.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace bandvox::render_test {

/// A scene and what looks along rays through its volumes.
class MediumScene {
  public:
    MediumScene(Scene scene, const PictureOptions& options,
                const Progress& progress = silentProgress())
        : mCamera(options.camera, 10, 10, std::vector<openvdb::Vec3d>{openvdb::Vec3d(0.0)}),
          mLamps(scene.lights, mCamera),
          mPrepared(scene, options, silentProgress()),
          mTransport(mPrepared, mLamps, options, progress),
          mProbes(mPrepared.probes()) {}

    double left(const Ray& ray, std::uint32_t number = 0,
                double end = std::numeric_limits<double>::max()) {
        SampleStream numbers(1, number, 0, 0);
        return mTransport.left(ray, end, numbers, mProbes);
    }
    MediumLight along(const Ray& ray, std::uint32_t number = 0,
                      double end = std::numeric_limits<double>::max()) {
        SampleStream numbers(2, number, 0, 0);
        return mTransport.along(ray, end, {}, numbers, mProbes);
    }

  private:
    Camera mCamera;
    Lamps mLamps;
    PreparedScene mPrepared;
    MediumTransport mTransport;
    SceneProbes mProbes;
};

/// A volume of this extinction, which scatters nothing.
inline SceneObject volumeOf(const openvdb::FloatGrid::ConstPtr& grid, double extinction) {
    SceneObject object;
    object.kind = SceneObject::Kind::Volume;
    object.grid = grid;
    object.medium.extinction = extinction;
    object.medium.color = openvdb::Vec3d(0.0);
    return object;
}

inline const openvdb::Vec3d kBlobMiddle(3.3, -2.6, 4.2);  ///< index coordinates

/// exp(-r² / 2σ²) around kBlobMiddle, under the default filter if σ is 1.41 or more.
inline openvdb::FloatGrid::Ptr blobGrid(double sigma) {
    const int reach = static_cast<int>(5 * sigma) + 2;
    const openvdb::Coord middle = openvdb::Coord::round(kBlobMiddle);
    return makeGrid({middle.offsetBy(-reach), middle.offsetBy(reach)}, {},
                    [sigma](const openvdb::Vec3d& x) {
                        return std::exp(-0.5 * (x - kBlobMiddle).lengthSqr() / (sigma * sigma));
                    });
}

/// ∫ of blobGrid's density along a whole line, world units.
inline double throughBlob(const openvdb::FloatGrid& grid, double sigma, const Ray& ray) {
    const openvdb::Vec3d origin = grid.worldToIndex(ray.origin) - kBlobMiddle;
    const openvdb::Vec3d step =
        grid.worldToIndex(ray.origin + ray.direction) - kBlobMiddle - origin;
    const double beside = origin.cross(step.unit()).lengthSqr();
    return std::sqrt(2 * std::numbers::pi) * sigma / step.length() *
           std::exp(-0.5 * beside / (sigma * sigma));
}

/// Rays that pass a place from 200 world units away, `beside` at most from it.
std::vector<Ray> raysPast(const openvdb::Vec3d& place, double beside, int count);

}  // namespace bandvox::render_test

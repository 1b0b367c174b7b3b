#pragma once

#include "render/lamps.h"
#include "render/prepared_scene.h"
#include "render/sample_stream.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>

namespace bandvox {

/// What volumes do to a part of a ray.
struct MediumLight {
    openvdb::Vec3d light{0, 0, 0};  ///< that they send along it
    double left = 1;                ///< of the light behind them
    double depth = 0;  ///< where on the ray what is seen of them lies, on average; world units
};

/// Light in the volumes of a scene: stopped, sent out, and scattered once.
class MediumTransport {
  public:
    /// `progress` must live as long as this.
    MediumTransport(const PreparedScene& scene, const Lamps& lamps, const PictureOptions& options,
                    const Progress& progress = silentProgress());

    /// Along a ray, 0 ≤ t ≤ `end`. Throws Error(ErrorKind::Interrupted) if the caller wants to
    /// stop: a ray may go through very many voxels.
    MediumLight along(const Ray& ray, double end, const InsideOf& inside, SampleStream& numbers,
                      SceneProbes& probes) const;

    /// The part of light that is left along a ray up to `end`.
    double left(const Ray& ray, double end, SampleStream& numbers, SceneProbes& probes) const;

  private:
    // A part of a ray, and the steps that the volumes in it need.
    struct Interval {
        double begin, end, step;
    };
    std::vector<Interval> intervalsOf(std::size_t volume, const Ray& ray, double end) const;
    std::vector<Interval> intervals(const Ray& ray, double end) const;
    double depthBySteps(std::size_t volume, const Ray& ray, double t0, double t1,
                        VolumeProbe& probe) const;
    template <typename Visitor>
    void forEachStep(const Ray& ray, double end, double longer, const Visitor& visit) const;
    MediumLight alongBySteps(const Ray& ray, double end, const InsideOf& inside,
                             SampleStream& numbers, SceneProbes& probes) const;
    MediumLight alongByTracking(const Ray& ray, double end, const InsideOf& inside,
                                SampleStream& numbers, SceneProbes& probes) const;
    openvdb::Vec3d source(int volume, const openvdb::Vec3d& place, const Ray& ray,
                          const InsideOf& inside, SampleStream& numbers, SceneProbes& probes) const;

    const PreparedScene& mScene;
    const Lamps& mLamps;
    const TransportOptions mTransport;
    VolumeOptions::Method mMethod;
    std::vector<double> mSteps;  // of each volume, world units
    double mLongSteps = 1;  // how much longer they are where only the sum of the density counts
    const Progress& mProgress;
    openvdb::Vec3d mAround{0, 0, 0};  // the mean of the light from around
};

/// What part of scattered light goes on at an angle with this cosine to where it came from, per
/// solid angle. L. Henyey, J. Greenstein: "Diffuse Radiation in the Galaxy" (1941).
double henyeyGreenstein(double cosine, double anisotropy);

}  // namespace bandvox

#include "render/medium_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace bandvox {

using openvdb::Vec3d;
using std::numbers::pi;

namespace {

// What is left of light that nobody sees any more.
constexpr double kNothingLeft = 1e-4;

// Steps towards lamps, along which only the sum of the density counts: two voxels see all of a
// band-limited one but what is near their own frequency, half a cycle per voxel.
constexpr double kLongSteps = 2;

// In a block of which most is far thinner than its densest place, random places would be tried for
// ever: after so many the rest is followed by so many steps.
constexpr int kMostTries = 2048;
constexpr int kBlockSteps = 64;

// Where a depth is reached that is reached between two places.
double placeOfDepth(const VolumeObject& volume, const Ray& ray, double t0, double t1, double depth,
                    VolumeProbe& probe) {
    const double length = (t1 - t0) / kBlockSteps;
    for (int i = 0; i < kBlockSteps; ++i) {
        const double t = t0 + (i + 0.5) * length;
        depth -= length * volume.extinctionAt(ray.origin + t * ray.direction, probe);
        if (depth <= 0) return t;
    }
    return t1;
}

// The mean of the light from around.
Vec3d meanOf(const Environment& environment) {
    return environment.map ? environment.color * environment.map->mean() : environment.color;
}

}  // namespace

double henyeyGreenstein(double cosine, double g) {
    return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

MediumTransport::MediumTransport(const PreparedScene& scene, const Lamps& lamps,
                                 const PictureOptions& options, const Progress& progress)
    : mScene(scene),
      mLamps(lamps),
      mTransport(options.transport),
      mMethod(options.volumes.method),
      mProgress(progress),
      mAround(meanOf(scene.environment())) {
    bool areBandLimited = true;
    for (const auto& volume : scene.volumes()) {
        mSteps.push_back(options.volumes.step * volume->voxel());
        areBandLimited = areBandLimited && volume->isBandLimited();
    }
    if (areBandLimited) mLongSteps = kLongSteps;
}

MediumLight MediumTransport::along(const Ray& ray, double end, const InsideOf& inside,
                                   SampleStream& numbers, SceneProbes& probes) const {
    if (mScene.volumes().empty()) return {};
    return mMethod == VolumeOptions::Method::Steps
               ? alongBySteps(ray, end, inside, numbers, probes)
               : alongByTracking(ray, end, inside, numbers, probes);
}

// The parts of a ray in which there is anything of a volume, in order, those that touch joined to
// one.
std::vector<MediumTransport::Interval> MediumTransport::intervalsOf(std::size_t i, const Ray& ray,
                                                                    double end) const {
    std::vector<Interval> found;
    mScene.volumes()[i]->walk(ray, end, [&](double t0, double t1, double /*most*/) {
        t1 = std::min(t1, end);
        // What rounding leaves between two blocks is no gap.
        if (!found.empty() && t0 <= found.back().end + 1e-3 * mSteps[i]) {
            found.back().end = std::max(found.back().end, t1);
        } else if (t1 > t0) {
            found.push_back({t0, t1, mSteps[i]});
        }
        return false;
    });
    return found;
}

// The same of all volumes, with the shortest steps of those that are there.
std::vector<MediumTransport::Interval> MediumTransport::intervals(const Ray& ray,
                                                                  double end) const {
    if (mSteps.size() == 1) return intervalsOf(0, ray, end);
    std::vector<Interval> all;
    std::vector<double> borders;
    for (std::size_t i = 0; i < mSteps.size(); ++i) {
        for (const Interval& interval : intervalsOf(i, ray, end)) {
            all.push_back(interval);
            borders.push_back(interval.begin);
            borders.push_back(interval.end);
        }
    }
    std::sort(borders.begin(), borders.end());
    std::vector<Interval> found;
    for (std::size_t b = 1; b < borders.size(); ++b) {
        const double middle = 0.5 * (borders[b - 1] + borders[b]);
        double step = std::numeric_limits<double>::max();
        bool isFilled = false;
        for (const Interval& interval : all) {
            if (!(interval.begin < middle && middle < interval.end)) continue;
            isFilled = true;
            step = std::min(step, interval.step);
        }
        if (!isFilled) continue;
        if (!found.empty() && found.back().end == borders[b - 1] && found.back().step == step) {
            found.back().end = borders[b];
        } else {
            found.push_back({borders[b - 1], borders[b], step});
        }
    }
    return found;
}

// Calls visit(t, length) for the middles of steps, so many times as long as usual; stops when it
// returns true. Of a band-limited density that is nothing at the ends of its interval, their sum is
// the integral: what the step does not see is above the band.
template <typename Visitor>
void MediumTransport::forEachStep(const Ray& ray, double end, double longer,
                                  const Visitor& visit) const {
    for (const Interval& interval : intervals(ray, end)) {
        const double steps = std::ceil((interval.end - interval.begin) / (longer * interval.step));
        const double length = (interval.end - interval.begin) / steps;
        for (double i = 0; i < steps; ++i) {
            if (visit(interval.begin + (i + 0.5) * length, length)) return;
        }
    }
}

MediumLight MediumTransport::alongBySteps(const Ray& ray, double end, const InsideOf& inside,
                                          SampleStream& numbers, SceneProbes& probes) const {
    MediumLight result;
    double seen = 0;
    forEachStep(ray, end, 1, [&](double t, double length) {
        mProgress.throwIfInterrupted();
        const Vec3d place = ray.origin + t * ray.direction;
        Vec3d light(0.0);
        double extinction = 0;
        for (int i = 0; i < static_cast<int>(mScene.volumes().size()); ++i) {
            const double part = mScene.volumes()[i]->extinctionAt(place, probes.volumes[i]);
            if (!(part * length > 1e-7)) continue;
            extinction += part;
            light += part * source(i, place, ray, inside, numbers, probes);
        }
        if (!(extinction > 0)) return false;
        // Within a step all is alike.
        const double passes = std::exp(-extinction * length);
        const double stopped = result.left * (1 - passes);
        result.light += stopped / extinction * light;
        result.depth += stopped * t;
        seen += stopped;
        result.left *= passes;
        return result.left < kNothingLeft;
    });
    if (seen > 0) result.depth /= seen;
    return result;
}

// The first place where something stops the light, drawn by how likely that is: E. Woodcock et al.
// (1965). Several volumes are independent of each other.
MediumLight MediumTransport::alongByTracking(const Ray& ray, double end, const InsideOf& inside,
                                             SampleStream& numbers, SceneProbes& probes) const {
    int stopped = -1;
    double nearest = end;
    for (int i = 0; i < static_cast<int>(mScene.volumes().size()); ++i) {
        const VolumeObject& volume = *mScene.volumes()[i];
        volume.walk(ray, nearest, [&](double t0, double t1, double most) {
            mProgress.throwIfInterrupted();
            double t = t0;
            for (int tries = 0; tries < kMostTries; ++tries) {
                t -= std::log(1 - numbers.next()) / most;
                if (t >= std::min(t1, nearest)) return t1 >= nearest;
                const double here =
                    volume.extinctionAt(ray.origin + t * ray.direction, probes.volumes[i]);
                if (numbers.next() * most < here) {
                    nearest = t;
                    stopped = i;
                    return true;
                }
            }
            // The rest of the block is followed by steps.
            const double last = std::min(t1, nearest);
            const double depth = -std::log(1 - numbers.next());
            if (depthBySteps(i, ray, t, last, probes.volumes[i]) < depth) return t1 >= nearest;
            nearest = placeOfDepth(volume, ray, t, last, depth, probes.volumes[i]);
            stopped = i;
            return true;
        });
    }
    if (stopped < 0) return {};
    const Vec3d place = ray.origin + nearest * ray.direction;
    return {source(stopped, place, ray, inside, numbers, probes), 0, nearest};
}

double MediumTransport::depthBySteps(std::size_t i, const Ray& ray, double t0, double t1,
                                     VolumeProbe& probe) const {
    const double length = (t1 - t0) / kBlockSteps;
    double depth = 0;
    for (int step = 0; step < kBlockSteps; ++step) {
        const double t = t0 + (step + 0.5) * length;
        depth += length * mScene.volumes()[i]->extinctionAt(ray.origin + t * ray.direction, probe);
    }
    return depth;
}

// The light that a place of a volume sends against a ray, if so much of it is there that nothing
// passes.
Vec3d MediumTransport::source(int i, const Vec3d& place, const Ray& ray, const InsideOf& inside,
                              SampleStream& numbers, SceneProbes& probes) const {
    const VolumeObject& volume = *mScene.volumes()[i];
    Vec3d arriving(0.0);
    for (int lamp = 0; lamp < mLamps.count(); ++lamp) {
        const LampSample sample = mLamps.sample(lamp, place, numbers.next2());
        const Ray towards{place, sample.direction};
        Vec3d light = pi *
                      henyeyGreenstein(sample.direction.dot(ray.direction), volume.anisotropy()) *
                      sample.color;
        if (mTransport.shadows) light *= mScene.passing(towards, sample.distance, inside, probes);
        if (light.lengthSqr() > 0) light *= left(towards, sample.distance, numbers, probes);
        arriving += light;
    }
    if (mTransport.gather == 0) {
        arriving += mAround;
    } else {
        // Look in one direction for what comes from around.
        const openvdb::Vec2d u = numbers.next2();
        const double z = 1 - 2 * u[0], across = std::sqrt(std::max(1 - z * z, 0.0));
        const Vec3d direction(across * std::cos(2 * pi * u[1]), across * std::sin(2 * pi * u[1]),
                              z);
        const double end = mTransport.gatherDistance > 0 ? mTransport.gatherDistance
                                                         : std::numeric_limits<double>::max();
        const Ray outward{place, direction};
        const double phase =
            4 * pi * henyeyGreenstein(direction.dot(ray.direction), volume.anisotropy());
        const double through = left(outward, end, numbers, probes);
        arriving += phase * through * mScene.passing(outward, end, inside, probes) *
                    mScene.environmentAlong(direction);
    }
    Vec3d sent = volume.colorAt(place) * arriving;
    if (volume.glows()) sent += volume.glowAt(place, probes.volumes[i]);
    return sent;
}

double MediumTransport::left(const Ray& ray, double end, SampleStream& numbers,
                             SceneProbes& probes) const {
    if (mScene.volumes().empty()) return 1;
    if (mMethod == VolumeOptions::Method::Steps) {
        double depth = 0;
        const double deepest = -std::log(kNothingLeft);
        forEachStep(ray, end, mLongSteps, [&](double t, double length) {
            const Vec3d place = ray.origin + t * ray.direction;
            for (std::size_t i = 0; i < mScene.volumes().size(); ++i) {
                depth += length * mScene.volumes()[i]->extinctionAt(place, probes.volumes[i]);
            }
            return depth > deepest;
        });
        return std::exp(-depth);
    }
    // Ratio tracking: J. Novák, A. Selle, W. Jarosz: "Residual Ratio Tracking for Estimating
    // Attenuation in Participating Media" (2014).
    double passes = 1;
    for (std::size_t i = 0; i < mScene.volumes().size(); ++i) {
        const VolumeObject& volume = *mScene.volumes()[i];
        volume.walk(ray, end, [&](double t0, double t1, double most) {
            double t = t0;
            for (int tries = 0; tries < kMostTries; ++tries) {
                t -= std::log(1 - numbers.next()) / most;
                if (t >= std::min(t1, end)) return false;
                const double here =
                    volume.extinctionAt(ray.origin + t * ray.direction, probes.volumes[i]);
                passes *= std::max(1 - here / most, 0.0);
                if (passes < 1e-6) return true;
            }
            passes *= std::exp(-depthBySteps(i, ray, t, std::min(t1, end), probes.volumes[i]));
            return passes < 1e-6;
        });
    }
    return passes;
}

}  // namespace bandvox

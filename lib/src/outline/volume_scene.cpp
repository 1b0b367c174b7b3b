#include "outline/volume_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// What one volume is asked.
class VolumeReader {
  public:
    explicit VolumeReader(const VolumeSurface& surface)
        : mSurface(surface), mProbe(surface.object->probe()), mContour(surface) {}

    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) {
        const auto found = spaceBetween(mContour, placeOf(a), placeOf(b), share);
        CurvePoint point = found ? mContour.seen(*found) : share < 0.5 ? a : b;
        point.corner = false;
        return point;
    }

    /// How often the surface is passed before a place of another one.
    int countBefore(const CurvePoint& point) {
        return countUpTo(mSurface.view.placeOf({point.x, point.y, point.z}), 0);
    }

    /// The same for a place of its own, which is met, too: what is within half a voxel of it can
    /// only be told by which side of the surface the line of sight comes from.
    int countBeforeOwn(const CurvePoint& point) {
        constexpr double kNear = 0.5;
        const Vec3d place = placeOf(point);
        const SpacePoint space = mContour.at(place);
        const bool comesFromInside = space.turn > 0;
        const int count = countUpTo(place, kNear);
        return (count % 2 == 1) == comesFromInside ? count : count + 1;
    }

    double foldAt(const CurvePoint& point) { return mContour.at(placeOf(point)).g; }

  private:
    static Vec3d placeOf(const CurvePoint& p) { return {p.u, p.v, p.s}; }

    int countUpTo(const Vec3d& place, double gap) {
        // A place beyond the surface from which to go on.
        constexpr double kBeyond = 0.02;
        const double far = mSurface.size + (place - mSurface.middle).length();
        const Vec3d start = mSurface.view.start(place, far);
        const double length = (place - start).length(), end = length - gap;
        const Vec3d direction = (place - start) / length;
        const RayMarch& march = mSurface.object->march();
        int count = 0;
        for (double t = 0; t < end;) {
            const Ray ray{start + t * direction, direction};
            const auto hit = count % 2 == 0 ? march.firstHit(ray, *mProbe, end - t)
                                            : march.firstExit(ray, *mProbe, end - t);
            if (!hit) break;
            ++count;
            t += hit->t + kBeyond;
        }
        return count;
    }

    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
    ContourEquations mContour;
};

class VolumeSceneReader final : public CurveReader {
  public:
    VolumeSceneReader(std::span<const VolumeSurface> volumes, const CurveScene* patches) {
        mVolumes.reserve(volumes.size());
        for (const VolumeSurface& volume : volumes) mVolumes.emplace_back(volume);
        if (patches != nullptr) mPatches = patches->reader();
    }

    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) override {
        if (isOfVolume(a) != isOfVolume(b) || a.patch != b.patch) return share < 0.5 ? a : b;
        return isOfVolume(a) ? volumeOf(a).between(a, b, share) : mPatches->between(a, b, share);
    }

    int countBefore(const CurvePoint& point) override {
        int count = mPatches ? mPatches->countBefore(point) : 0;
        for (std::size_t k = 0; k < mVolumes.size(); ++k) {
            const bool isOwn = isOfVolume(point) && static_cast<std::size_t>(point.patch) == k;
            count += isOwn ? mVolumes[k].countBeforeOwn(point) : mVolumes[k].countBefore(point);
        }
        return count;
    }

    double foldAt(const CurvePoint& point, bool isOther) override {
        return isOfVolume(point) ? volumeOf(point).foldAt(point) : mPatches->foldAt(point, isOther);
    }

  private:
    static bool isOfVolume(const CurvePoint& point) { return point.rule == CurveRule::Volume; }
    VolumeReader& volumeOf(const CurvePoint& p) {
        return mVolumes[static_cast<std::size_t>(p.patch)];
    }

    std::vector<VolumeReader> mVolumes;
    std::unique_ptr<CurveReader> mPatches;
};

}  // namespace

std::unique_ptr<CurveReader> VolumeScene::reader() const {
    return std::make_unique<VolumeSceneReader>(mVolumes, mPatches);
}

}  // namespace bandvox

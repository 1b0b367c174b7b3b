#include "outline/volumes/volume_scene.h"

#include "outline/volumes/pierced_patches.h"
#include "outline/volumes/suggestive_equations.h"

#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// What one volume is asked.
class VolumeReader {
  public:
    explicit VolumeReader(const VolumeSurface& surface)
        : mSurface(surface),
          mProbe(surface.object->probe()),
          mContour(surface),
          mMiddleDepth(surface.view.place(surface.middle)[2]),
          mToWorld(surface.object->grid()
                       .transform()
                       .baseMap()
                       ->getAffineMap()
                       ->getMat4()
                       .getMat3()
                       .inverse()) {}

    /// How often the surface is passed before a place of another one.
    int countBefore(const CurvePoint& point) { return countUpTo(placeSeen(point), 0); }

    /// The same for a place of its own, which is met, too: what is within half a voxel of it can
    /// only be told by which side of the surface the line of sight comes from.
    int countBeforeOwn(const CurvePoint& point) {
        constexpr double kNear = 0.5;
        const Vec3d place = placeSeen(point);
        const SpacePoint space = mContour.at(place);
        const bool isFold = point.rule == CurveRule::VolumeFold;
        const bool comesFromInside = isFold ? space.turn > 0 : space.g < 0;
        const int count = countUpTo(place, kNear);
        return (count % 2 == 1) == comesFromInside ? count : count + 1;
    }

    double foldAt(const CurvePoint& point) { return mContour.side(placeSeen(point)); }

    /// Where the line of sight at a place of the page enters the solid.
    struct Entry {
        Vec3d place;
        double z;      ///< depth on the page
        double zEven;  ///< nearer than this is as near as the entry, as densities are known
    };
    std::optional<Entry> firstAt(double x, double y) {
        constexpr double kEven = 1e-3;  // voxels
        const Vec3d place = mSurface.view.placeOf({x, y, mMiddleDepth});
        const double far = mSurface.size + (place - mSurface.middle).length();
        const Vec3d start = mSurface.view.start(place, far);
        const Vec3d direction = (place - start).unit();
        const Ray ray{start, direction};
        const auto hit = mSurface.object->march().firstHit(ray, *mProbe, 4 * far);
        if (!hit) return std::nullopt;
        const Vec3d entered = start + hit->t * direction;
        const auto depthOf = [&](const Vec3d& p) { return mSurface.view.place(p)[2]; };
        return Entry{entered, depthOf(entered), depthOf(entered + kEven * direction)};
    }

    /// Of the angle between a light, world, and the normal out of the solid.
    double cosineAt(const Vec3d& place, const Vec3d& light) {
        const Vec3d normal = -(mToWorld * mProbe->evaluate(place).gradient);
        const double length = normal.length();
        return length > 0 ? normal.dot(light) / length : 0;
    }
    double cosineAt(const CurvePoint& point, const Vec3d& light) {
        return cosineAt(placeSeen(point), light);
    }

  private:
    // Places of the volume's own curves are known exactly.
    Vec3d placeSeen(const CurvePoint& p) const {
        if (isOfVolume(p.rule) && p.patch == mSurface.index) return {p.u, p.v, p.s};
        return mSurface.view.placeOf({p.x, p.y, p.z});
    }

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
    double mMiddleDepth;
    openvdb::Mat3d mToWorld;  // of gradients
};

class VolumeSceneReader final : public CurveReader {
  public:
    VolumeSceneReader(std::span<const VolumeSurface> volumes, const CurveScene* patches,
                      const LitPatches& lit, int firstObject)
        : mSurfaces(volumes),
          mLit(lit),
          mLight(lit.light[0], lit.light[1], lit.light[2]),
          mFirstObject(firstObject) {
        mVolumes.reserve(volumes.size());
        for (const VolumeSurface& volume : volumes) mVolumes.emplace_back(volume);
        if (patches != nullptr) mPatches = patches->reader();
    }

    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) override {
        const bool isPiercing =
            a.rule == CurveRule::Piercing && b.rule == CurveRule::Piercing && a.other == b.other;
        if (isPiercing && a.patch == b.patch) return finderOf(a.other).between(a, b, share);
        if (!isOfVolume(a.rule) && !isOfVolume(b.rule)) return mPatches->between(a, b, share);
        CurvePoint point = share < 0.5 ? a : b;
        if (a.rule == b.rule && a.patch == b.patch) {
            CurveEquations& equations = equationsOf(a);
            const auto found = spaceBetween(equations, {a.u, a.v, a.s}, {b.u, b.v, b.s}, share);
            if (found) point = equations.seen(*found);
        }
        point.corner = false;
        return point;
    }

    int countBefore(const CurvePoint& point) override {
        int count = mPatches ? mPatches->countBefore(point) : 0;
        for (std::size_t k = 0; k < mVolumes.size(); ++k) {
            const auto number = static_cast<int>(k);
            const bool isOfOther = isOfVolume(point.rule) || point.rule == CurveRule::Piercing;
            const bool isOwn = (isOfVolume(point.rule) && point.patch == number) ||
                               (isOfOther && point.other == number);
            count += isOwn ? mVolumes[k].countBeforeOwn(point) : mVolumes[k].countBefore(point);
        }
        return count;
    }

    double foldAt(const CurvePoint& point, bool isOther) override {
        if (point.rule == CurveRule::Piercing && isOther) {
            return mVolumes[static_cast<std::size_t>(point.other)].foldAt(point);
        }
        if (!isOfVolume(point.rule)) return mPatches->foldAt(point, isOther);
        const int number = isOther && point.other >= 0 ? point.other : point.patch;
        return mVolumes[static_cast<std::size_t>(number)].foldAt(point);
    }

    SeenSurface seenAt(double x, double y) override {
        SeenSurface first = mPatches ? mPatches->seenAt(x, y) : SeenSurface();
        for (std::size_t k = 0; k < mVolumes.size(); ++k) {
            const auto entry = mVolumes[k].firstAt(x, y);
            // Of surfaces in the same place rounding does not choose.
            if (!entry || (first.object >= 0 && entry->zEven >= first.z)) continue;
            first = {mFirstObject + static_cast<int>(k), entry->z,
                     mVolumes[k].cosineAt(entry->place, mLight)};
        }
        return first;
    }

    double cosineAt(const CurvePoint& point) override {
        if (!isOfVolume(point.rule)) return mPatches->cosineAt(point);
        return mVolumes[static_cast<std::size_t>(point.patch)].cosineAt(point, mLight);
    }

  private:
    PiercingFinder& finderOf(int volume) {
        auto& finder = mFinders[volume];
        if (!finder) {
            finder =
                std::make_unique<PiercingFinder>(mLit, mSurfaces[static_cast<std::size_t>(volume)]);
        }
        return *finder;
    }

    CurveEquations& equationsOf(const CurvePoint& p) {
        auto& equations = mEquations[{static_cast<int>(p.rule), p.patch, p.other, p.t}];
        const VolumeSurface& surface = mSurfaces[static_cast<std::size_t>(p.patch)];
        if (equations) return *equations;
        if (p.rule == CurveRule::VolumeMeeting) {
            const VolumeSurface& other = mSurfaces[static_cast<std::size_t>(p.other)];
            equations = std::make_unique<MeetingEquations>(surface, other);
        } else if (p.rule == CurveRule::VolumeIsophote) {
            equations = std::make_unique<IsophoteEquations>(surface, mLight, p.t);
        } else if (p.rule == CurveRule::Suggestive) {
            equations = std::make_unique<SuggestiveEquations>(surface, 0);
        } else {
            equations = std::make_unique<ContourEquations>(surface);
        }
        return *equations;
    }

    std::span<const VolumeSurface> mSurfaces;
    const LitPatches& mLit;
    Vec3d mLight;
    int mFirstObject;
    std::vector<VolumeReader> mVolumes;
    std::unique_ptr<CurveReader> mPatches;
    std::map<int, std::unique_ptr<PiercingFinder>> mFinders;  // by volume
    // By rule, volumes and cosine.
    std::map<std::tuple<int, int, int, double>, std::unique_ptr<CurveEquations>> mEquations;
};

}  // namespace

std::unique_ptr<CurveReader> VolumeScene::reader() const {
    return std::make_unique<VolumeSceneReader>(mVolumes, mPatches, mLit, mFirstObject);
}

}  // namespace bandvox

#include "render/ray_march.h"

#include "core/rounding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {

namespace {

// Voxels.
constexpr double kShortestStep = 0.25;
// A step of Newton's method as short as this ends within 1e-5 of the root.
constexpr double kLastRootStep = 3e-4;
constexpr double kRootError = 1e-5;
// From a place to the nearest node.
const double kFarthestNode = 0.5 * std::sqrt(3.0);

// A root takes about three; more than this only if the density is no smooth function.
constexpr int kMostRootSteps = 100;

// Where nothing is known of the densities.
constexpr double kInnerStep = 0.5;

// A place on the ray and how far the density there is above iso, or, on the way out, below.
struct Sample {
    double t;
    double above;
};

// Places where the parabola through three samples, the middle one the highest, has its top.
double parabolaTop(const Sample& a, const Sample& b, const Sample& c) {
    const double left = (b.t - a.t) * (b.above - c.above);
    const double right = (b.t - c.t) * (b.above - a.above);
    return b.t - 0.5 * ((b.t - a.t) * left - (b.t - c.t) * right) / (left - right);
}

// What a march goes through.
struct Field {
    DensityProbe& density;
    double iso;
    const ClearDistance* clear;  // of the side that is left; null if nothing is known
    const openvdb::FloatGrid* lattice;
};

// One line of sight on its way through the blocks, into the solid (side 1) or out of it (side -1).
class March {
  public:
    // The line of sight begins at `earliest`, which is not positive.
    March(const Ray& ray, double earliest, const Field& field, int side)
        : mRay(ray),
          mEarliest(earliest),
          mField(field),
          mSide(side),
          mVoxel(1 / ray.direction.length()) {
        if (field.lattice && field.clear) mNodes.emplace(field.lattice->tree());
    }

    // Marches on through [t0, t1]. True once the surface is found.
    bool through(double t0, double t1) {
        // Between blocks there is no surface: start afresh.
        if (t0 > mNext) mSamples = 0;
        double t = std::max(t0, mNext);
        while (t < t1) {
            const double known = clearByNode(t);
            double step = known;
            if (known > kShortestStep) {
                mSamples = 0;
            } else {
                if (arrive(at(t))) return true;
                step = mField.clear ? std::max(kShortestStep, (*mField.clear)(mLast.above))
                                    : kInnerStep;
            }
            const double next = t + step * mVoxel;
            if (!(next > t)) return false;
            t = mNext = next;
        }
        mNext = t;
        return false;
    }

    const RayHit& hit() const { return mHit; }

  private:
    // How far the surface is at least, as the nearest node tells; 0 if it does not.
    double clearByNode(double t) {
        if (!mNodes) return 0;
        const openvdb::Vec3d place = mRay.origin + t * mRay.direction;
        const openvdb::Coord node(floorToInt(place[0] + 0.5), floorToInt(place[1] + 0.5),
                                  floorToInt(place[2] + 0.5));
        const double above = mSide * (mNodes->getValue(node) - mField.iso);
        return above < 0 ? (*mField.clear)(above)-kFarthestNode : 0;
    }

    Sample at(double t) const {
        const double density = mField.density.value(mRay.origin + t * mRay.direction);
        return {t, mSide * (density - mField.iso)};
    }

    bool arrive(const Sample& next) {
        if (next.above >= 0) {
            if (mSamples > 0) {
                mHit = root(mLast, next);
            } else {
                enter(next);
            }
            return true;
        }
        // A top between the samples may reach above iso although they do not: a silhouette.
        if (mSamples > 1 && mLast.above > mBefore.above && mLast.above > next.above) {
            const Sample top = at(parabolaTop(mBefore, mLast, next));
            if (top.above >= 0) {
                mHit = root(top.t > mLast.t ? mLast : mBefore, top);
                return true;
            }
        }
        mBefore = mLast;
        mLast = next;
        ++mSamples;
        return false;
    }

    // The ray is inside where it is first looked at. If it was outside a voxel before, then the
    // surface is between; else the ray starts inside.
    void enter(const Sample& inside) {
        const double before = std::max(inside.t - mVoxel, mEarliest);
        if (before < inside.t) {
            const Sample outside = at(before);
            if (outside.above < 0) {
                mHit = root(outside, inside);
                return;
            }
        }
        mHit = {before, mField.density.evaluate(mRay.origin + before * mRay.direction).gradient};
    }

    // Where the density rises to iso: Newton's method, kept in a bracket.
    RayHit root(Sample outside, Sample inside) const {
        const double width = inside.t - outside.t;
        double t = outside.t + width * outside.above / (outside.above - inside.above);
        double lastStep = width;
        RayHit hit{inside.t, openvdb::Vec3d(0.0)};
        for (int i = 0; i < kMostRootSteps; ++i) {
            const DensityAt found = mField.density.evaluate(mRay.origin + t * mRay.direction);
            const double above = mSide * (found.value - mField.iso);
            const double slope = mSide * found.gradient.dot(mRay.direction);
            hit = {t, found.gradient};
            (above < 0 ? outside : inside) = {t, above};
            double next = t - above / slope;
            const bool converges = slope > 0 && std::abs(next - t) < 0.5 * lastStep;
            if (converges && std::abs(next - t) <= kLastRootStep * mVoxel) {
                hit.t = std::clamp(next, outside.t, inside.t);
                break;
            }
            if (!converges || !(next > outside.t && next < inside.t)) {
                next = 0.5 * (outside.t + inside.t);
            }
            if (inside.t - outside.t <= kRootError * mVoxel) break;
            lastStep = std::abs(next - t);
            t = next;
        }
        return hit;
    }

    const Ray& mRay;
    double mEarliest;
    const Field& mField;
    int mSide;
    double mVoxel;  // a voxel's length, in lengths of the direction
    std::optional<openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>> mNodes;
    int mSamples = 0;  // taken one after another, up to mLast
    Sample mBefore{0, 0}, mLast{0, 0};
    double mNext = std::numeric_limits<double>::lowest();  // where to look next
    RayHit mHit;
};

std::optional<RayHit> marchAlong(const Ray& ray, const SurfaceBlocks& blocks, const Field& field,
                                 int side, double end) {
    // Count t from where the blocks begin: seen from far away, steps would be lost in rounding.
    const std::optional<double> start = blocks.entry(ray);
    if (!start || *start > end) return std::nullopt;
    const Ray near{ray.origin + *start * ray.direction, ray.direction};
    March march(near, -*start, field, side);
    bool found = false;
    blocks.walk(near, end - *start,
                [&](double t0, double t1) { return found = march.through(t0, t1); });
    if (!found) return std::nullopt;
    RayHit hit = march.hit();
    hit.t += *start;
    if (hit.t > end) return std::nullopt;
    return hit;
}

}  // namespace

ClearDistance::ClearDistance(double depth, double densityError,
                             const std::function<double(double)>& distance)
    : mScale(kSteps / depth) {
    for (int i = 0; i <= kSteps; ++i) {
        mVoxels[i] = static_cast<float>(distance(i / mScale - densityError));
    }
}

ClearDistance ClearDistance::ofSlope(double iso, double background, double steepest,
                                     double densityError) {
    return ClearDistance(iso - background, densityError,
                         [&](double below) { return below / steepest; });
}

ClearDistance ClearDistance::ofGaussian(double iso, double cutoff, double densityError) {
    // Invert s(r) = erfc(π k_c r) / 2, the density outside a half-space, by bisection.
    const auto distanceFromFace = [&](double density) {
        double low = -20 / cutoff, high = 20 / cutoff;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            const double found = 0.5 * std::erfc(std::numbers::pi * cutoff * middle);
            (found > density ? low : high) = middle;
        }
        return low;
    };
    const double surface = distanceFromFace(iso);
    return ClearDistance(iso, densityError,
                         [&](double below) { return distanceFromFace(iso - below) - surface; });
}

double ClearDistance::aboveWithin(double voxels) const {
    const auto farther = std::upper_bound(mVoxels.begin(), mVoxels.end(), voxels);
    return -double(farther - mVoxels.begin()) / mScale;
}

DensityBand askedBand(double iso, const ClearDistance& outside, const ClearDistance& inside) {
    const double reach = kFarthestNode + kShortestStep;
    return {static_cast<float>(iso + outside.aboveWithin(reach)),
            static_cast<float>(iso - inside.aboveWithin(reach))};
}

std::optional<RayHit> RayMarch::firstHit(const Ray& ray, DensityProbe& density, double end) const {
    return marchAlong(ray, mBlocks, {density, mIso, &mClear, mLattice}, 1, end);
}

std::optional<RayHit> RayMarch::firstExit(const Ray& ray, DensityProbe& density, double end) const {
    return marchAlong(ray, mBlocks, {density, mIso, mInside ? &*mInside : nullptr, mLattice}, -1,
                      end);
}

}  // namespace bandvox

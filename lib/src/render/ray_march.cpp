#include "render/ray_march.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {

namespace {

// Voxels.
constexpr double kShortestStep = 0.25;
constexpr double kRootError = 1e-5;

// A root takes about ten; more than this only if the density is no smooth function.
constexpr int kMostRootSteps = 200;

// A place on the ray and how far the density there is above iso.
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

// One line of sight on its way through the blocks.
class March {
  public:
    // The line of sight begins at `earliest`, which is not positive.
    March(const Ray& ray, double earliest, DensityProbe& density, double iso,
          const ClearDistance& clear)
        : mRay(ray),
          mEarliest(earliest),
          mDensity(density),
          mIso(iso),
          mClear(clear),
          mVoxel(1 / ray.direction.length()) {}

    // Marches on through [t0, t1]. True once the surface is found.
    bool through(double t0, double t1) {
        if (mSamples == 0 || t0 > mLast.t) {
            // Between blocks there is no surface: start afresh.
            mSamples = 0;
            if (arrive(at(t0))) return true;
        }
        while (mLast.t < t1) {
            const double step = std::max(kShortestStep, mClear(mLast.above)) * mVoxel;
            const double next = mLast.t + step;
            if (!(next > mLast.t)) return false;
            if (arrive(at(next))) return true;
        }
        return false;
    }

    RayHit hit() const {
        return {mHit, mDensity.evaluate(mRay.origin + mHit * mRay.direction).gradient};
    }

  private:
    Sample at(double t) const {
        return {t, mDensity.value(mRay.origin + t * mRay.direction) - mIso};
    }

    bool arrive(const Sample& next) {
        if (next.above >= 0) {
            mHit = mSamples > 0 ? root(mLast, next) : entry(next);
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

    // The ray is inside where its first block starts. If it was outside a voxel before, then the
    // surface is between; else the ray starts inside.
    double entry(const Sample& inside) const {
        const double before = std::max(inside.t - mVoxel, mEarliest);
        if (before == inside.t) return inside.t;
        const Sample outside = at(before);
        return outside.above < 0 ? root(outside, inside) : before;
    }

    // Where the density rises to iso: regula falsi, Illinois variant, which keeps a bracket.
    double root(Sample outside, Sample inside) const {
        const double error = kRootError * mVoxel;
        int side = 0;
        for (int i = 0; i < kMostRootSteps && inside.t - outside.t > error; ++i) {
            const double width = inside.t - outside.t;
            const double secant =
                outside.t + width * outside.above / (outside.above - inside.above);
            // Step a little over the root, so that the other end follows.
            const double guard = std::min(0.5 * error, 0.25 * width);
            const double place = std::clamp(secant, outside.t + guard, inside.t - guard);
            if (!(place > outside.t && place < inside.t)) break;
            const Sample next = at(place);
            if (next.above < 0) {
                outside = next;
                if (side < 0) inside.above *= 0.5;
                side = -1;
            } else {
                inside = next;
                if (side > 0) outside.above *= 0.5;
                side = 1;
            }
        }
        return 0.5 * (outside.t + inside.t);
    }

    const Ray& mRay;
    double mEarliest;
    DensityProbe& mDensity;
    double mIso;
    const ClearDistance& mClear;
    double mVoxel;  // a voxel's length, in lengths of the direction
    int mSamples = 0;
    Sample mBefore{0, 0}, mLast{0, 0};
    double mHit = 0;
};

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

std::optional<RayHit> RayMarch::firstHit(const Ray& ray, DensityProbe& density) const {
    // Count t from where the blocks begin: seen from far away, steps would be lost in rounding.
    const std::optional<double> start = mBlocks.entry(ray);
    if (!start) return std::nullopt;
    const Ray near{ray.origin + *start * ray.direction, ray.direction};
    March march(near, -*start, density, mIso, mClear);
    bool found = false;
    mBlocks.walk(near, [&](double t0, double t1) { return found = march.through(t0, t1); });
    if (!found) return std::nullopt;
    RayHit hit = march.hit();
    hit.t += *start;
    return hit;
}

}  // namespace bandvox

#include "outline/volumes/march_curves.h"

#include <openvdb/math/Coord.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// Steps, voxels. The density has no detail that is much smaller than three of them.
constexpr double kLongestVoxelStep = 0.5, kShortestVoxelStep = 1e-4;

// How close a place is to a curve that it belongs to, voxels.
constexpr double kSame = 0.05;

// The largest angle between directions of points that follow each other, as a cosine: 12 degrees.
constexpr double kLeastCosine = 0.978;

struct ChainPoint {
    SpacePoint space;
    CurvePoint seen;
};
using Chain = std::vector<ChainPoint>;

/// Pieces of curves that are known, by the voxels that they are in.
class KnownPieces {
  public:
    void add(const Vec3d& a, const Vec3d& b) {
        const auto index = static_cast<std::uint32_t>(mPieces.size());
        mPieces.emplace_back(a, b);
        mVoxels[key(voxelOf(0.5 * (a + b)))].push_back(index);
    }

    bool contain(const Vec3d& p) const {
        const openvdb::Coord voxel = voxelOf(p);
        for (int n = 0; n < 27; ++n) {
            const auto found =
                mVoxels.find(key(voxel.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1)));
            if (found == mVoxels.end()) continue;
            for (const std::uint32_t index : found->second) {
                const auto& [a, b] = mPieces[index];
                const Vec3d along = b - a;
                const double square = along.lengthSqr();
                const double share =
                    square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0;
                if ((a + share * along - p).length() < kSame) return true;
            }
        }
        return false;
    }

  private:
    static openvdb::Coord voxelOf(const Vec3d& p) { return openvdb::Coord::floor(p); }
    static std::uint64_t key(const openvdb::Coord& c) {
        constexpr std::uint64_t kBits = 0x1FFFFF;
        return (static_cast<std::uint64_t>(c[0]) & kBits) << 42U |
               (static_cast<std::uint64_t>(c[1]) & kBits) << 21U |
               (static_cast<std::uint64_t>(c[2]) & kBits);
    }

    std::vector<std::pair<Vec3d, Vec3d>> mPieces;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> mVoxels;
};

/// Follows curves point by point.
class CurveMarch {
  public:
    CurveMarch(CurveEquations& equations, const CurveSampling& sampling, Progress& progress)
        : mEquations(equations), mSampling(sampling), mProgress(progress) {}

    void march(const Vec3d& place) {
        if (mKnown.contain(place)) return;
        const ChainPoint start = pointOf(mEquations.at(place));
        if (start.space.tangent().lengthSqr() == 0 || !mEquations.holds(start.space)) return;
        Chain chain{start};
        const bool isClosed = follow(chain, 1);
        if (!isClosed) {
            Chain back{start};
            follow(back, -1);
            std::reverse(back.begin(), back.end());
            back.insert(back.end(), chain.begin() + 1, chain.end());
            chain = std::move(back);
        }
        for (std::size_t i = 1; i < chain.size(); ++i) {
            mKnown.add(chain[i - 1].space.at, chain[i].space.at);
        }
        if (chain.size() > 1) mCurves.push_back(curveOf(chain, isClosed));
    }

    std::vector<Curve> take() { return std::move(mCurves); }

  private:
    ChainPoint pointOf(const SpacePoint& space) const { return {space, mEquations.seen(space)}; }

    // Goes on until the curve is closed, which gives true, or ends.
    bool follow(Chain& chain, int sense) {
        double step = 0.5 * kLongestVoxelStep, length = 0;
        while (true) {
            if (chain.size() % 1024 == 0) mProgress.throwIfInterrupted();
            const ChainPoint& last = chain.back();
            std::optional<ChainPoint> next;
            while (!next && step >= kShortestVoxelStep) {
                next = stepFrom(chain, sense, step);
                if (!next) step *= 0.5;
            }
            if (!next) return false;
            const Vec3d move = next->space.at - last.space.at;
            length += move.length();
            if (chain.size() > 2 && passesStart(chain, *next)) {
                // Two points in nearly the same place have no direction between them.
                const double rest = (chain.front().space.at - chain.back().space.at).length();
                if (rest < 0.1 * move.length()) chain.pop_back();
                chain.push_back(chain.front());
                return true;
            }
            if (mKnown.contain(next->space.at)) return false;
            if (!mEquations.holds(next->space)) {
                const SpacePoint end =
                    changeBetween(last.space, next->space, 1e-3,
                                  [&](const SpacePoint& p) { return mEquations.holds(p); });
                if (end.at != last.space.at) chain.push_back(pointOf(end));
                return false;
            }
            const bool isSmooth = last.space.tangent().dot(next->space.tangent()) > 0.994 &&
                                  bowBetween(last.seen, next->seen) < 0.3 * mSampling.flatness;
            chain.push_back(*next);
            if (isSmooth) step = std::min(kLongestVoxelStep, 1.4 * step);
        }
    }

    // The last place between two, by halving to a share of the way, of which `isLikeFirst` says
    // yes, as of the first.
    template <class IsLikeFirst>
    SpacePoint changeBetween(const SpacePoint& a, const SpacePoint& b, double nearEnough,
                             const IsLikeFirst& isLikeFirst) {
        double low = 0, high = 1;
        SpacePoint last = a;
        while (high - low > nearEnough) {
            const double share = 0.5 * (low + high);
            const auto middle = spaceBetween(mEquations, a.at, b.at, share);
            if (!middle) break;
            const bool isLow = isLikeFirst(*middle);
            if (isLow) last = *middle;
            (isLow ? low : high) = share;
        }
        return last;
    }

    bool passesStart(const Chain& chain, const ChainPoint& next) const {
        const Vec3d a = chain.back().space.at, along = next.space.at - a;
        const Vec3d start = chain.front().space.at - a;
        const double share = start.dot(along) / along.lengthSqr();
        if (share < 0 || share > 1) return false;
        const Vec3d across = start - share * along;
        return across.length() < std::max(kSame, 0.2 * along.length()) &&
               chain.front().space.tangent().dot(next.space.tangent()) > 0;
    }

    std::optional<ChainPoint> stepFrom(const Chain& chain, int sense, double step) {
        const SpacePoint& from = chain.back().space;
        const Vec3d along = sense * from.tangent();
        Vec3d guess = from.at + step * along;
        if (chain.size() > 1) {
            // On an arc that goes on as the last step did.
            const SpacePoint& before = chain[chain.size() - 2].space;
            const double last = (from.at - before.at).length();
            if (last > 0.1 * step) {
                guess += 0.5 * step * step / last * (along - sense * before.tangent());
            }
        }
        const auto found = ontoCurve(mEquations, guess, 0.5 * step);
        if (!found) return std::nullopt;
        const Vec3d tangent = found->tangent(), move = found->at - from.at;
        if (!(sense * tangent.dot(along) > kLeastCosine)) return std::nullopt;
        if (!(move.dot(along) > 0.5 * step)) return std::nullopt;
        ChainPoint next = pointOf(*found);
        const bool isDense = step > 100 * kShortestVoxelStep &&
                             bowBetween(chain.back().seen, next.seen) > mSampling.flatness;
        if (isDense) return std::nullopt;
        return next;
    }

    // A curve does not begin beside a place where its image turns back.
    static void turnChain(Chain& chain) {
        const auto isBack = [&](std::size_t i) { return chain[i].space.turn < 0; };
        chain.pop_back();
        for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
            if (isBack(i - 1) != isBack(i) || isBack(i) != isBack(i + 1)) continue;
            std::rotate(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(i), chain.end());
            break;
        }
        chain.push_back(chain.front());
    }

    Curve curveOf(Chain& chain, bool isClosed) {
        if (isClosed) turnChain(chain);
        Curve curve;
        curve.closed = isClosed;
        curve.points.push_back(chain.front().seen);
        for (std::size_t i = 1; i < chain.size(); ++i) {
            if ((chain[i - 1].space.turn < 0) != (chain[i].space.turn < 0)) {
                curve.points.push_back(turnBetween(chain[i - 1], chain[i]));
            }
            curve.points.push_back(chain[i].seen);
        }
        clearCorners(curve);
        return curve;
    }

    // Near where the image turns back its two branches are as good as one. A small pair of corners
    // that nobody can see is none.
    void clearCorners(Curve& curve) const {
        const double clear = 0.25 * mSampling.flatness;
        auto& points = curve.points;
        std::vector<bool> isLeft(points.size(), true);
        for (std::size_t c = 1; c + 1 < points.size(); ++c) {
            if (!points[c].corner || !isLeft[c]) continue;
            const auto isNear = [&](std::size_t i) {
                return std::hypot(points[i].x - points[c].x, points[i].y - points[c].y) < clear;
            };
            std::size_t begin = c, end = c + 1, corners = 1;
            while (begin > 1 && isNear(begin - 1) && !points[begin - 1].corner) --begin;
            for (; end + 1 < points.size() && isNear(end); ++end) {
                corners += points[end].corner ? 1 : 0;
            }
            std::fill(isLeft.begin() + static_cast<std::ptrdiff_t>(begin),
                      isLeft.begin() + static_cast<std::ptrdiff_t>(end), false);
            isLeft[c] = corners % 2 == 1;
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (isLeft[i]) points[kept++] = points[i];
        }
        points.resize(kept);
    }

    // Where the curve's image turns back.
    CurvePoint turnBetween(const ChainPoint& a, const ChainPoint& b) {
        const auto isBefore = [&](const SpacePoint& p) {
            return (p.turn < 0) == (a.space.turn < 0);
        };
        CurvePoint turn = mEquations.seen(changeBetween(a.space, b.space, 1e-6, isBefore));
        turn.corner = true;
        return turn;
    }

    CurveEquations& mEquations;
    const CurveSampling& mSampling;
    Progress& mProgress;
    KnownPieces mKnown;
    std::vector<Curve> mCurves;
};

}  // namespace

std::vector<Curve> marchCurves(CurveEquations& equations, std::span<const Vec3d> places,
                               const CurveSampling& sampling, Progress& progress) {
    CurveMarch march(equations, sampling, progress);
    for (const Vec3d& place : places) march.march(place);
    return march.take();
}

}  // namespace bandvox

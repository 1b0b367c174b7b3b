#include "outline/drawing/visible_pieces.h"

#include "outline/drawing/crossings.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace bandvox {
namespace {

/// A curve by its length.
class CurveRuler {
  public:
    explicit CurveRuler(const Curve& curve) : mLengths{0} {
        const auto& p = curve.points;
        for (std::size_t i = 1; i < p.size(); ++i) {
            mLengths.push_back(mLengths.back() +
                               std::hypot(p[i].x - p[i - 1].x, p[i].y - p[i - 1].y));
        }
    }
    double whole() const { return mLengths.back(); }

    double lengthAt(double place) const {
        const auto [i, share] = parts(place);
        return mLengths[i] + share * (mLengths[i + 1] - mLengths[i]);
    }
    double placeAt(double length) const {
        const auto above = std::upper_bound(mLengths.begin() + 1, mLengths.end() - 1, length);
        const auto i = static_cast<std::size_t>(above - mLengths.begin()) - 1;
        const double step = mLengths[i + 1] - mLengths[i];
        const double share = step > 0 ? std::clamp((length - mLengths[i]) / step, 0.0, 1.0) : 0;
        return static_cast<double>(i) + share;
    }
    std::pair<std::size_t, double> parts(double place) const {
        const auto i = std::min(static_cast<std::size_t>(place), mLengths.size() - 2);
        return {i, place - static_cast<double>(i)};
    }

  private:
    std::vector<double> mLengths;
};

/// Finds out how much is in front of one curve.
class CurveSight {
  public:
    CurveSight(const Curve& curve, const CurveScene& scene, const CurveSampling& sampling)
        : mCurve(curve), mReader(scene.reader()), mSampling(sampling), mRuler(curve) {}

    std::vector<VisiblePiece> cut(const CurvePlaces& places) {
        std::vector<double> stops{0, mRuler.whole()};
        for (const double place : places) stops.push_back(mRuler.lengthAt(place));
        for (std::size_t i = 0; i < mCurve.points.size(); ++i) {
            if (mCurve.points[i].corner) stops.push_back(mRuler.lengthAt(static_cast<double>(i)));
        }
        std::sort(stops.begin(), stops.end());
        const double least = 1e-2 * mSampling.flatness;
        for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
            if (stops[i + 1] - stops[i] > least) examine(stops[i], stops[i + 1]);
        }
        return pieces();
    }

  private:
    struct Run {
        double from, to;
        int hidden;
    };

    CurvePoint pointAt(double length) const {
        const auto [i, share] = mRuler.parts(mRuler.placeAt(length));
        constexpr double kOnPoint = 1e-9;  // of the way
        if (share < kOnPoint) return mCurve.points[i];
        if (share > 1 - kOnPoint) return mCurve.points[i + 1];
        return mReader->between(mCurve.points[i], mCurve.points[i + 1], share);
    }

    int hiddenAt(double length) const { return mReader->countBefore(pointAt(length)); }

    void examine(double from, double to) {
        const double span = to - from;
        std::vector<double> where{from + 0.2 * span, from + 0.5 * span, from + 0.8 * span};
        // Long parts are looked at more often.
        const int more = std::min(40, static_cast<int>(span / (0.02 * mSampling.size)));
        for (int k = 1; k <= more; ++k) where.push_back(from + span * k / (more + 1));
        // Changes that were not foreseen mostly are near the ends.
        for (const double away : {1e-3, 4e-3, 1.2e-2}) {
            const double inward = away * mSampling.size;
            if (inward > 0.2 * span) break;
            where.push_back(from + inward);
            where.push_back(to - inward);
        }
        std::sort(where.begin(), where.end());
        std::vector<int> hidden;
        hidden.reserve(where.size());
        for (const double length : where) hidden.push_back(hiddenAt(length));
        if (isChance(hidden)) return add({from, to, mostFrequent(hidden)});
        double begin = from;
        for (std::size_t k = 1; k < where.size(); ++k) {
            if (hidden[k] == hidden[k - 1]) continue;
            const double change = changeBetween(where[k - 1], where[k], hidden[k - 1]);
            add({begin, change, hidden[k - 1]});
            begin = change;
        }
        add({begin, to, hidden.back()});
    }

    // Where a volume is seen edge-on, and as flat as is known, lines of sight tell now this, now
    // that.
    bool isChance(const std::vector<int>& hidden) const {
        if (!isOfVolume(mCurve.points[0].rule)) return false;
        int changes = 0;
        for (std::size_t k = 1; k < hidden.size(); ++k) changes += hidden[k] != hidden[k - 1];
        return changes > 1;
    }

    static int mostFrequent(const std::vector<int>& hidden) {
        int best = hidden[0];
        for (const int candidate : hidden) {
            const auto count = std::count(hidden.begin(), hidden.end(), candidate);
            if (count > std::count(hidden.begin(), hidden.end(), best)) best = candidate;
        }
        return best;
    }

    double changeBetween(double low, double high, int hiddenLow) const {
        while (high - low > 0.1 * mSampling.flatness) {
            const double middle = 0.5 * (low + high);
            (hiddenAt(middle) == hiddenLow ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    void add(const Run& run) {
        if (!mRuns.empty() && mRuns.back().hidden == run.hidden) {
            mRuns.back().to = run.to;
        } else {
            mRuns.push_back(run);
        }
    }

    // Puts runs that are shorter than anyone can see to what is beside them.
    void dropCrumbs() {
        const double least = mSampling.flatness;
        std::vector<Run> kept;
        for (const Run& run : mRuns) {
            const bool isCrumb = run.to - run.from < least && mRuns.size() > 1;
            if (!kept.empty() && (isCrumb || kept.back().hidden == run.hidden)) {
                kept.back().to = run.to;
            } else {
                kept.push_back(run);
            }
        }
        mRuns = std::move(kept);
    }

    std::vector<VisiblePiece> pieces() {
        std::vector<VisiblePiece> result;
        dropCrumbs();
        if (mRuns.empty()) return result;
        mRuns.front().from = 0;
        mRuns.back().to = mRuler.whole();
        if (mRuns.size() == 1) {
            result.push_back({mCurve, mRuns[0].hidden});
            return result;
        }
        for (const Run& run : mRuns) result.push_back({part(run), run.hidden});
        if (mCurve.closed && mRuns.front().hidden == mRuns.back().hidden) {
            auto& points = result.back().curve.points;
            const auto& more = result.front().curve.points;
            points.insert(points.end(), more.begin(), more.end());
            result.front() = std::move(result.back());
            result.pop_back();
        }
        return result;
    }

    // A corner is one of several points in the same place.
    CurvePoint endAt(double length) const {
        if (length == 0) return mCurve.points.front();
        if (length == mRuler.whole()) return mCurve.points.back();
        CurvePoint end = pointAt(length);
        const std::size_t i = mRuler.parts(mRuler.placeAt(length)).first;
        const std::size_t last = std::min(i + 2, mCurve.points.size() - 1);
        for (std::size_t k = i > 0 ? i - 1 : 0; k <= last; ++k) {
            const double away = std::abs(mRuler.lengthAt(static_cast<double>(k)) - length);
            end.corner |= mCurve.points[k].corner && away < 1e-9 * mSampling.size;
        }
        return end;
    }

    Curve part(const Run& run) const {
        Curve part{.kind = mCurve.kind, .object = mCurve.object, .isDrawn = mCurve.isDrawn};
        const auto begin = mRuler.parts(mRuler.placeAt(run.from)).first + 1;
        const auto end = mRuler.parts(mRuler.placeAt(run.to)).first;
        part.points.push_back(endAt(run.from));
        for (std::size_t i = begin; i <= end; ++i) part.points.push_back(mCurve.points[i]);
        part.points.push_back(endAt(run.to));
        return part;
    }

    const Curve& mCurve;
    std::unique_ptr<CurveReader> mReader;
    const CurveSampling& mSampling;
    CurveRuler mRuler;
    std::vector<Run> mRuns;
};

}  // namespace

std::vector<VisiblePiece> visiblePieces(std::span<const Curve> curves, const CurveScene& scene,
                                        const CurveSampling& sampling, Progress& progress) {
    const std::vector<CurvePlaces> places = crossings(curves, *scene.reader(), sampling);
    std::vector<std::vector<VisiblePiece>> parts(curves.size());
    parallelFor(static_cast<std::int64_t>(curves.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto k = static_cast<std::size_t>(i);
        parts[k] = CurveSight(curves[k], scene, sampling).cut(places[k]);
    });
    std::vector<VisiblePiece> result;
    for (auto& some : parts) {
        for (VisiblePiece& piece : some) result.push_back(std::move(piece));
    }
    return result;
}

}  // namespace bandvox

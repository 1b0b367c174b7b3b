#pragma once

#include "outline/drawing/page_view.h"
#include "outline/drawing/visible_pieces.h"
#include "outline/exact_sheets.h"
#include "outline/patches/patch_scene.h"
#include "outline/patches/refine_point.h"
#include "outline/patches/surface_curves.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace bandvox::outline_test {

/// Lines of a view before they are fitted.
struct DrawnView {
    std::vector<ViewPatch> seen;
    std::vector<VisiblePiece> pieces;
    double size = 0, pixel = 0;  ///< of the page; a pixel is 1/1000 of it
};

inline DrawnView draw(const std::vector<BezierPatch>& patches, const OutlineOptions& options) {
    DrawnView drawn;
    drawn.size = std::max(options.width, options.height);
    drawn.pixel = drawn.size / 1000;
    const ViewMatrix view = pageView(patches, options);
    for (const BezierPatch& patch : patches) {
        drawn.seen.push_back(seenBy(view, patch, drawn.size));
    }
    const CurveSampling sampling{.flatness = 0.25 * options.tolerance, .size = drawn.size};
    const LitPatches lit{patches, drawn.seen, lightDirection(contentOf(patches), options)};
    const auto curves = surfaceCurves(lit, options, sampling, silentProgress());
    drawn.pieces = visiblePieces(curves, PatchScene(lit, drawn.size), sampling, silentProgress());
    return drawn;
}

/// Places that are wrong, and how many were looked at.
struct Findings {
    int samples = 0, wrong = 0, miscounted = 0;
    std::vector<std::string> messages;
};

inline std::string describe(const CurvePoint& p, OutlineKind kind) {
    static const char* const kNames[] = {"contour",      "boundary", "crease",
                                         "intersection", "isophote", "suggestive"};
    std::string text = kNames[static_cast<int>(kind)];
    text += " at (";
    text += std::to_string(p.x);
    text += ", ";
    text += std::to_string(p.y);
    text += ", ";
    text += std::to_string(p.z);
    text += ") patch ";
    text += std::to_string(p.patch);
    text += " (";
    text += std::to_string(p.u);
    text += ", ";
    text += std::to_string(p.v);
    text += ") ";
    return text;
}

/// Whether a line turns back or sharply within a distance of a place.
inline bool isNearCorner(const DrawnView& drawn, const CurvePoint& p, double reach) {
    for (const VisiblePiece& piece : drawn.pieces) {
        for (const CurvePoint& q : piece.curve.points) {
            if (q.corner && std::hypot(q.x - p.x, q.y - p.y) < reach) return true;
        }
    }
    return false;
}

/// A piece, and how far each of its points is along it.
class MeasuredPiece {
  public:
    MeasuredPiece(const DrawnView& drawn, const Curve& curve) : mDrawn(drawn), mCurve(curve) {
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            mLengths.push_back(mLengths.back() +
                               std::hypot(curve.points[i].x - curve.points[i - 1].x,
                                          curve.points[i].y - curve.points[i - 1].y));
        }
    }

    double length() const { return mLengths.back(); }
    CurvePoint at(double length) const {
        const auto above = std::upper_bound(mLengths.begin(), mLengths.end(), length);
        const auto i = std::clamp(static_cast<std::size_t>(above - mLengths.begin()),
                                  std::size_t(1), mLengths.size() - 1);
        const double step = mLengths[i] - mLengths[i - 1];
        return pointBetween(mDrawn.seen, mCurve.points[i - 1], mCurve.points[i],
                            step > 0 ? (length - mLengths[i - 1]) / step : 0);
    }

  private:
    const DrawnView& mDrawn;
    const Curve& mCurve;
    std::vector<double> mLengths{0};
};

/// What lies before a place, by exact lines of sight. The curve's own surface is met, too: twice at
/// a fold, and at depths that are as wrong as the root of what the place is.
inline std::vector<double> depthsBefore(const DrawnView& drawn, const ExactSheets& oracle,
                                        const CurvePoint& p, OutlineKind kind) {
    const double margin = kind == OutlineKind::Contour ? 1.5e-7 : 1e-11;
    return oracle.depthsBefore(p.x, p.y, p.z - margin * drawn.size);
}

inline Findings checkPiece(const DrawnView& drawn, const VisiblePiece& piece,
                           const ExactSheets& oracle) {
    const auto& [curve, hidden] = piece;
    Findings result;
    const MeasuredPiece measured(drawn, curve);
    const double length = measured.length();
    const double reach = 0.2 * drawn.pixel;
    const double away = curve.closed ? 0 : reach;
    if (length <= 2 * away) return result;
    const int count = std::max(10, static_cast<int>(length / (5 * drawn.pixel)));
    for (int k = 0; k < count; ++k) {
        const double at = away + (length - 2 * away) * (k + 0.5) / count;
        const CurvePoint p = measured.at(at);
        if (isNearCorner(drawn, p, reach)) continue;
        const auto depths = depthsBefore(drawn, oracle, p, curve.kind);
        ++result.samples;
        if (static_cast<int>(depths.size()) != hidden) ++result.miscounted;
        if (depths.empty() == (hidden == 0)) continue;
        ++result.wrong;
        std::string message = describe(p, curve.kind);
        message += "is hidden " + std::to_string(hidden);
        message += " times, by lines of sight " + std::to_string(depths.size());
        if (!depths.empty()) message += ", first " + std::to_string(p.z - depths[0]);
        message += ", " + std::to_string(std::min(at, length - at)) + " from an end";
        result.messages.push_back(message);
    }
    return result;
}

/// Compares ten or more samples of each piece with exact lines of sight; what is within 0.2 pixels
/// of a piece's ends or of a corner is left out. `wrong`: seen or not; `miscounted`: how many are
/// in front.
inline Findings checkVisibility(const DrawnView& drawn) {
    const ExactSheets oracle(drawn.seen);
    std::vector<Findings> found(drawn.pieces.size());
    parallelFor(static_cast<std::int64_t>(found.size()), [&](std::int64_t k) {
        const auto i = static_cast<std::size_t>(k);
        found[i] = checkPiece(drawn, drawn.pieces[i], oracle);
    });
    Findings sum;
    for (const Findings& some : found) {
        sum.samples += some.samples;
        sum.wrong += some.wrong;
        sum.miscounted += some.miscounted;
        sum.messages.insert(sum.messages.end(), some.messages.begin(), some.messages.end());
    }
    return sum;
}

/// Distance of a piece's end from lines, those of the piece itself but for what is near the end.
inline double distanceFromLines(const DrawnView& drawn, std::size_t own, const CurvePoint& p,
                                bool areSeen) {
    double nearest = HUGE_VAL;
    for (std::size_t k = 0; k < drawn.pieces.size(); ++k) {
        if (areSeen && drawn.pieces[k].hidden > 0) continue;
        const auto& points = drawn.pieces[k].curve.points;
        const bool isStart = &p == &points.front();
        double length = 0, whole = 0;
        for (std::size_t i = 1; i < points.size(); ++i) {
            whole += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
        }
        for (std::size_t i = 1; i < points.size(); ++i) {
            const CurvePoint &a = points[i - 1], &b = points[i];
            const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
            const double before = length;
            length += std::sqrt(square);
            const double away = isStart ? before : whole - length;
            if (k == own && away < 2 * drawn.pixel) continue;
            const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
            const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
            nearest = std::min(nearest, std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y));
        }
    }
    return nearest;
}

/// Every free end of a line that is seen has to be at a cusp, or on another line that is seen; one
/// of a hidden line on any other line.
inline Findings checkEnds(const DrawnView& drawn) {
    Findings result;
    for (std::size_t i = 0; i < drawn.pieces.size(); ++i) {
        const auto& [curve, hidden] = drawn.pieces[i];
        if (curve.closed) continue;
        for (const CurvePoint* end : {&curve.points.front(), &curve.points.back()}) {
            ++result.samples;
            if (isNearCorner(drawn, *end, 0.05 * drawn.pixel)) continue;
            const double away = distanceFromLines(drawn, i, *end, hidden == 0);
            if (away < 0.05 * drawn.pixel) continue;
            ++result.wrong;
            std::string message = describe(*end, curve.kind);
            message += "hidden " + std::to_string(hidden);
            message += " ends " + std::to_string(away) + " from a line";
            result.messages.push_back(message);
        }
    }
    return result;
}

}  // namespace bandvox::outline_test

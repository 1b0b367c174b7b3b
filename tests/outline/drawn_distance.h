#pragma once

#include "outline/drawing/page_view.h"
#include "outline/patches/surface_curves.h"

#include <bandvox/outline/patches_to_outline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox::outline_test {

using Place = std::array<double, 2>;

inline Place onCubic(const OutlinePath& path, std::size_t piece, double t) {
    const double s = 1 - t;
    const std::array<double, 4> b{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    Place place{};
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t c = 0; c < 2; ++c) place[c] += b[k] * path.points[3 * piece + k][c];
    }
    return place;
}

template <class Visit>
void alongPath(const OutlinePath& path, int samples, Visit&& visit) {
    for (std::size_t piece = 0; 3 * piece + 3 < path.points.size(); ++piece) {
        for (int k = 0; k <= samples; ++k) visit(onCubic(path, piece, double(k) / samples));
    }
}

/// Chains of places, by the squares of a page that they go through.
class ChainGrid {
  public:
    explicit ChainGrid(double size) : mCell(size / kCells), mCells(kCells * kCells) {}

    void add(const Place& a, const Place& b) {
        const auto [x0, x1] = std::minmax(a[0], b[0]);
        const auto [y0, y1] = std::minmax(a[1], b[1]);
        for (std::size_t j = index(y0); j <= index(y1); ++j) {
            for (std::size_t i = index(x0); i <= index(x1); ++i) {
                mCells[j * kCells + i].push_back({a, b});
            }
        }
    }

    /// Infinite if nothing is within a cell's width.
    double distance(const Place& p) const {
        double nearest = HUGE_VAL;
        const std::size_t i1 = index(p[0] + mCell), j1 = index(p[1] + mCell);
        for (std::size_t j = index(p[1] - mCell); j <= j1; ++j) {
            for (std::size_t i = index(p[0] - mCell); i <= i1; ++i) {
                for (const auto& [a, b] : mCells[j * kCells + i]) {
                    nearest = std::min(nearest, fromSegment(p, a, b));
                }
            }
        }
        return nearest;
    }

  private:
    static constexpr std::size_t kCells = 200;

    std::size_t index(double x) const {
        return static_cast<std::size_t>(std::clamp(x / mCell, 0.0, kCells - 1.0));
    }
    static double fromSegment(const Place& p, const Place& a, const Place& b) {
        const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
        const double along = (p[0] - a[0]) * dx + (p[1] - a[1]) * dy;
        const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
        return std::hypot(a[0] + share * dx - p[0], a[1] + share * dy - p[1]);
    }

    double mCell;
    std::vector<std::vector<std::array<Place, 2>>> mCells;
};

/// The largest distance of a drawn place from the true curves of its kind, and of a true place from
/// what is drawn, hidden lines too.
inline double largestDistance(const Outline& outline, const PatchModel& model,
                              const OutlineOptions& options) {
    const ViewMatrix view = pageView(model.patches, options);
    const double size = std::max(options.width, options.height);
    std::vector<ViewPatch> seen;
    for (const BezierPatch& patch : model.patches) seen.push_back(seenBy(view, patch, size));
    const auto exact =
        surfaceCurves({model.patches, seen, {0, 0, 1}}, options,
                      {.flatness = 0.01 * options.tolerance, .size = size}, silentProgress());
    std::vector<ChainGrid> truth(4, ChainGrid(size)), drawn(4, ChainGrid(size));
    for (const Curve& curve : exact) {
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            const CurvePoint &a = curve.points[i - 1], &b = curve.points[i];
            truth[static_cast<std::size_t>(curve.kind)].add({a.x, a.y}, {b.x, b.y});
        }
    }
    double worst = 0;
    for (const OutlinePath& path : outline.paths) {
        const auto kind = static_cast<std::size_t>(path.kind);
        for (std::size_t piece = 0; 3 * piece + 3 < path.points.size(); ++piece) {
            constexpr int kSamples = 400;
            Place last = onCubic(path, piece, 0);
            for (int k = 1; k <= kSamples; ++k) {
                const Place p = onCubic(path, piece, double(k) / kSamples);
                drawn[kind].add(last, p);
                worst = std::max(worst, truth[kind].distance(p));
                last = p;
            }
        }
    }
    for (const Curve& curve : exact) {
        for (const CurvePoint& p : curve.points) {
            worst =
                std::max(worst, drawn[static_cast<std::size_t>(curve.kind)].distance({p.x, p.y}));
        }
    }
    return worst;
}

}  // namespace bandvox::outline_test

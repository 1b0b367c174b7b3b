#pragma once

#include "outline/view_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace bandvox::outline_test {

/// Patches as fine triangles, in space as the page sees it: what lines of sight meet, the slow way.
class TriangleSheets {
  public:
    TriangleSheets(std::span<const ViewPatch> patches, int steps, double size)
        : mCell(size / kCells), mCells(std::size_t{kCells} * kCells) {
        for (const ViewPatch& patch : patches) {
            std::vector<std::array<double, 3>> points;
            for (int i = 0; i <= steps; ++i) {
                for (int j = 0; j <= steps; ++j) {
                    const ViewPoint p = patch.at(double(i) / steps, double(j) / steps);
                    points.push_back({p.x, p.y, p.z});
                }
            }
            for (int i = 0; i < steps; ++i) {
                for (int j = 0; j < steps; ++j) {
                    const auto a = static_cast<std::size_t>(i * (steps + 1) + j);
                    const auto b = a + static_cast<std::size_t>(steps) + 1;
                    add({points[a], points[b], points[b + 1]});
                    add({points[a], points[b + 1], points[a + 1]});
                }
            }
        }
    }

    /// The depth of the nearest triangle behind (x, y); infinite if there is none.
    double nearest(double x, double y) const {
        double depth = HUGE_VAL;
        for (const std::size_t k : mCells[row(y) * kCells + row(x)]) {
            const auto& [a, b, c] = mTriangles[k];
            const auto area = [](const Point& p, const Point& q, double u, double v) {
                return (q[0] - p[0]) * (v - p[1]) - (q[1] - p[1]) * (u - p[0]);
            };
            const double wa = area(b, c, x, y), wb = area(c, a, x, y), wc = area(a, b, x, y);
            const bool isInside =
                (wa >= 0 && wb >= 0 && wc >= 0) || (wa <= 0 && wb <= 0 && wc <= 0);
            const double sum = wa + wb + wc;
            if (!isInside || sum == 0) continue;
            depth = std::min(depth, (wa * a[2] + wb * b[2] + wc * c[2]) / sum);
        }
        return depth;
    }

  private:
    static constexpr std::size_t kCells = 400;
    using Point = std::array<double, 3>;

    std::size_t row(double x) const {
        return static_cast<std::size_t>(std::clamp(x / mCell, 0.0, kCells - 1.0));
    }

    void add(const std::array<Point, 3>& t) {
        const auto [x0, x1] = std::minmax({t[0][0], t[1][0], t[2][0]});
        const auto [y0, y1] = std::minmax({t[0][1], t[1][1], t[2][1]});
        for (std::size_t j = row(y0); j <= row(y1); ++j) {
            for (std::size_t i = row(x0); i <= row(x1); ++i) {
                mCells[j * kCells + i].push_back(mTriangles.size());
            }
        }
        mTriangles.push_back(t);
    }

    double mCell;
    std::vector<std::array<Point, 3>> mTriangles;
    std::vector<std::vector<std::size_t>> mCells;
};

}  // namespace bandvox::outline_test

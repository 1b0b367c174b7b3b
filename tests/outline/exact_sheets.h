#pragma once

#include "outline/patches/view_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace bandvox::outline_test {

/// What lines of sight meet, the slow way and exactly: patches are divided in long double by what
/// their control points enclose until Newton's method finds the place, or there is none.
class ExactSheets {
  public:
    explicit ExactSheets(std::span<const ViewPatch> patches) {
        for (const ViewPatch& patch : patches) {
            Part whole{.patch = &patch, .m = patch.x.m, .n = patch.x.n};
            for (std::size_t k = 0; k < patch.x.c.size(); ++k) {
                const Real w = patch.w.c.size() > 1 ? patch.w.c[k] : 1;
                whole.points.push_back({patch.x.c[k], patch.y.c[k], patch.z.c[k], w});
            }
            if (patch.hasFold) addParts(whole, 0);
        }
    }

    /// The depths at which the line of sight through (x, y) meets patches before depth z,
    /// ascending; a place on a border of two patches counts once.
    std::vector<double> depthsBefore(double x, double y, double z) const {
        std::vector<Real> depths;
        for (std::size_t k = 0; k < mParts.size(); ++k) {
            const auto& [x0, x1, y0, y1] = mBoxes[k];
            if (x >= x0 && x <= x1 && y >= y0 && y <= y1) descend(mParts[k], {x, y, z}, depths);
        }
        std::sort(depths.begin(), depths.end());
        std::vector<double> result;
        for (const Real depth : depths) {
            constexpr double kSame = 1e-9;
            if (result.empty() || depth - result.back() > kSame) {
                result.push_back(static_cast<double>(depth));
            }
        }
        return result;
    }

  private:
    using Real = long double;
    using Point = std::array<Real, 4>;
    using Target = std::array<Real, 3>;

    static constexpr int kDepthOfParts = 4;
    static constexpr Real kSmallest = 1.0L / 16384;

    struct Part {
        const ViewPatch* patch = nullptr;
        int m = 0, n = 0;
        Real u0 = 0, v0 = 0, size = 1;
        std::vector<Point> points;
    };

    static std::array<Part, 4> quartersOf(const Part& part) {
        std::array<Part, 4> q;
        q.fill(part);
        const auto halve = [](std::vector<Point>& low, std::vector<Point>& high, std::size_t first,
                              int degree, std::size_t step) {
            const auto at = [&](int i) { return first + static_cast<std::size_t>(i) * step; };
            high[at(degree)] = low[at(degree)];
            for (int r = 1; r <= degree; ++r) {
                for (int i = degree; i >= r; --i) {
                    for (std::size_t c = 0; c < 4; ++c) {
                        low[at(i)][c] = (low[at(i)][c] + low[at(i - 1)][c]) / 2;
                    }
                }
                high[at(degree - r)] = low[at(degree)];
            }
        };
        const auto row = static_cast<std::size_t>(part.n + 1);
        for (std::size_t j = 0; j < row; ++j) halve(q[0].points, q[2].points, j, part.m, row);
        for (std::size_t i = 0; i <= static_cast<std::size_t>(part.m); ++i) {
            halve(q[0].points, q[1].points, i * row, part.n, 1);
            halve(q[2].points, q[3].points, i * row, part.n, 1);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            q[k].size = part.size / 2;
            q[k].u0 += k >= 2 ? q[k].size : 0;
            q[k].v0 += k % 2 == 1 ? q[k].size : 0;
        }
        return q;
    }

    void addParts(const Part& part, int depth) {
        if (depth == kDepthOfParts) {
            mParts.push_back(part);
            mBoxes.push_back(boxOf(part));
            return;
        }
        for (const Part& quarter : quartersOf(part)) addParts(quarter, depth + 1);
    }

    static std::array<double, 4> boxOf(const Part& part) {
        std::array<double, 4> box{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
        for (const Point& p : part.points) {
            const auto px = static_cast<double>(p[0] / p[3]), py = static_cast<double>(p[1] / p[3]);
            box = {std::min(box[0], px), std::max(box[1], px), std::min(box[2], py),
                   std::max(box[3], py)};
        }
        return box;
    }

    static bool mayMeet(const Part& part, const Target& t) {
        bool left = true, right = true, above = true, below = true, behind = true;
        for (const Point& p : part.points) {
            left &= p[0] < t[0] * p[3];
            right &= p[0] > t[0] * p[3];
            above &= p[1] < t[1] * p[3];
            below &= p[1] > t[1] * p[3];
            behind &= p[2] > t[2] * p[3];
        }
        return !(left || right || above || below || behind);
    }

    void descend(const Part& part, const Target& t, std::vector<Real>& depths) const {
        if (!mayMeet(part, t)) return;
        if (part.size > kSmallest) {
            for (const Part& quarter : quartersOf(part)) descend(quarter, t, depths);
            return;
        }
        settle(part, t, depths);
    }

    // Newton's method on the part itself, whose own parameters go from 0 to 1.
    void settle(const Part& part, const Target& t, std::vector<Real>& depths) const {
        Real u = 0.5L, v = 0.5L, moved = 1;
        for (int step = 0; step < 60; ++step) {
            const auto [p, du, dv] = jet(part, u, v);
            const Real a = du[0] - t[0] * du[3], b = dv[0] - t[0] * dv[3];
            const Real c = du[1] - t[1] * du[3], d = dv[1] - t[1] * dv[3];
            const Real gx = t[0] * p[3] - p[0], gy = t[1] * p[3] - p[1];
            const Real area = a * d - b * c;
            if (area == 0) return;
            const Real moveU = std::clamp((gx * d - gy * b) / area, -1.0L, 1.0L);
            const Real moveV = std::clamp((gy * a - gx * c) / area, -1.0L, 1.0L);
            u += moveU;
            v += moveV;
            if (std::abs(u - 0.5L) > 3 || std::abs(v - 0.5L) > 3) return;
            moved = std::max(std::abs(moveU), std::abs(moveV));
            if (moved < 1e-12L) break;
        }
        // It jumps to and fro where the line touches a fold, and passes, within rounding.
        if (moved > 1e-3L) return;
        constexpr Real kBeside = 1e-7L;
        if (u < -kBeside || u > 1 + kBeside || v < -kBeside || v > 1 + kBeside) return;
        const auto [p, du, dv] = jet(part, u, v);
        const Real z = p[2] / p[3];
        if (z < t[2]) depths.push_back(z);
    }

    static std::array<Point, 3> jet(const Part& part, Real u, Real v) {
        std::vector<Point> rows;
        std::vector<Point> slopes;
        for (int i = 0; i <= part.m; ++i) {
            const auto first = static_cast<std::size_t>(i * (part.n + 1));
            const auto [p, d] =
                line({part.points.begin() + static_cast<std::ptrdiff_t>(first),
                      part.points.begin() + static_cast<std::ptrdiff_t>(first) + part.n + 1},
                     v);
            rows.push_back(p);
            slopes.push_back(d);
        }
        const auto [p, du] = line(rows, u);
        return {p, du, line(slopes, u)[0]};
    }

    // De Casteljau's point and derivative.
    static std::array<Point, 2> line(std::vector<Point> c, Real t) {
        const auto degree = c.size() - 1;
        Point slope{};
        for (std::size_t r = degree; r >= 1; --r) {
            if (r == 1) {
                for (std::size_t k = 0; k < 4; ++k) {
                    slope[k] = static_cast<Real>(degree) * (c[1][k] - c[0][k]);
                }
            }
            for (std::size_t i = 0; i < r; ++i) {
                for (std::size_t k = 0; k < 4; ++k) {
                    c[i][k] = (1 - t) * c[i][k] + t * c[i + 1][k];
                }
            }
        }
        return {c[0], slope};
    }

    std::vector<Part> mParts;
    std::vector<std::array<double, 4>> mBoxes;  // on the page: least and largest x, y
};

}  // namespace bandvox::outline_test

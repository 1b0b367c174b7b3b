#pragma once

#include <bandvox/outline/outline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox::outline_test {

/// Calls visit with places along cubics, `steps` for each, the first anchor among them.
template <class Visit>
void alongCubics(const std::vector<std::array<double, 2>>& points, int steps, const Visit& visit) {
    for (std::size_t i = 0; i + 3 < points.size(); i += 3) {
        for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
            const double t = double(k) / steps, s = 1 - t;
            const std::array b{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
            std::array<double, 2> p{};
            for (std::size_t c = 0; c < 4; ++c) {
                p[0] += b[c] * points[i + c][0];
                p[1] += b[c] * points[i + c][1];
            }
            visit(p);
        }
    }
}

/// The fills of a drawing as pixels, by the rule of odd and even.
class FilledPage {
  public:
    /// `pixel`: how wide one is, page units.
    FilledPage(const Outline& outline, double pixel)
        : mPixel(pixel),
          mWidth(static_cast<int>(std::ceil(outline.width / pixel))),
          mHeight(static_cast<int>(std::ceil(outline.height / pixel))),
          mFill(static_cast<std::size_t>(mWidth) * static_cast<std::size_t>(mHeight), -1),
          mLayers(mFill.size(), 0),
          mIsNear(mFill.size(), false) {
        for (std::size_t f = 0; f < outline.fills.size(); ++f) {
            paint(outline.fills[f], static_cast<int>(f));
        }
        for (const OutlinePath& path : outline.paths) markNear(path.points);
    }

    int width() const { return mWidth; }
    int height() const { return mHeight; }
    std::array<double, 2> middle(int i, int j) const {
        return {(i + 0.5) * mPixel, (j + 0.5) * mPixel};
    }
    /// The number of the fill there, -1: none.
    int fillAt(int i, int j) const { return mFill[at(i, j)]; }
    /// How many fills cover a pixel's middle.
    int layersAt(int i, int j) const { return mLayers[at(i, j)]; }
    /// Whether a line or a fill's border passes within a pixel.
    bool isNearEdge(int i, int j) const { return mIsNear[at(i, j)]; }

  private:
    std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(mWidth) +
               static_cast<std::size_t>(i);
    }

    void paint(const OutlineFill& fill, int number) {
        std::vector<std::vector<double>> rows(static_cast<std::size_t>(mHeight));
        for (const auto& loop : fill.loops) {
            markNear(loop);
            std::vector<std::array<double, 2>> chain;
            alongCubics(loop, 64, [&](const auto& p) { chain.push_back(p); });
            for (std::size_t k = 0; k + 1 < chain.size(); ++k) cross(chain[k], chain[k + 1], rows);
        }
        for (int j = 0; j < mHeight; ++j) {
            auto& row = rows[static_cast<std::size_t>(j)];
            std::sort(row.begin(), row.end());
            for (std::size_t k = 0; k + 1 < row.size(); k += 2) {
                const int first = std::max(0, static_cast<int>(std::ceil(row[k] / mPixel - 0.5)));
                for (int i = first; i < mWidth && (i + 0.5) * mPixel < row[k + 1]; ++i) {
                    mFill[at(i, j)] = number;
                    ++mLayers[at(i, j)];
                }
            }
        }
    }

    void cross(const std::array<double, 2>& a, const std::array<double, 2>& b,
               std::vector<std::vector<double>>& rows) const {
        const double low = std::min(a[1], b[1]), high = std::max(a[1], b[1]);
        const int first = std::max(0, static_cast<int>(std::floor(low / mPixel - 0.5)));
        for (int j = first; j < mHeight; ++j) {
            const double y = (j + 0.5) * mPixel;
            if (y > high) break;
            if ((a[1] <= y) == (b[1] <= y)) continue;
            rows[static_cast<std::size_t>(j)].push_back(a[0] +
                                                        (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
        }
    }

    void markNear(const std::vector<std::array<double, 2>>& points) {
        for (std::size_t i = 0; i + 3 < points.size(); i += 3) {
            double length = 0;
            for (std::size_t c = 1; c < 4; ++c) {
                length += std::hypot(points[i + c][0] - points[i + c - 1][0],
                                     points[i + c][1] - points[i + c - 1][1]);
            }
            const int steps = 1 + static_cast<int>(4 * length / mPixel);
            alongCubics({points.begin() + static_cast<std::ptrdiff_t>(i),
                         points.begin() + static_cast<std::ptrdiff_t>(i) + 4},
                        steps, [&](const auto& p) { markNearPlace(p); });
        }
    }

    void markNearPlace(const std::array<double, 2>& p) {
        const int i0 = static_cast<int>(std::floor(p[0] / mPixel));
        const int j0 = static_cast<int>(std::floor(p[1] / mPixel));
        for (int j = std::max(0, j0 - 1); j <= std::min(mHeight - 1, j0 + 1); ++j) {
            for (int i = std::max(0, i0 - 1); i <= std::min(mWidth - 1, i0 + 1); ++i) {
                const auto [x, y] = middle(i, j);
                if (std::hypot(x - p[0], y - p[1]) <= mPixel) mIsNear[at(i, j)] = true;
            }
        }
    }

    double mPixel;
    int mWidth, mHeight;
    std::vector<int> mFill, mLayers;
    std::vector<bool> mIsNear;
};

}  // namespace bandvox::outline_test

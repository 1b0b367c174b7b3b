#pragma once

#include "outline/drawing/curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox {

/// Samples the image of a line whose place `at` tells: at(t) is a CurvePoint.
template <class At>
class LineSampler {
  public:
    LineSampler(const At& at, const CurveSampling& sampling) : mAt(at), mSampling(sampling) {}

    /// Appends the points after a, which is that of range[0], up to b.
    void refine(std::array<double, 2> range, const CurvePoint& a, const CurvePoint& b, int depth,
                std::vector<CurvePoint>& points) const {
        const double half = 0.5 * (range[0] + range[1]);
        const CurvePoint middle = mAt(half);
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double length = std::hypot(dx, dy);
        const double off = std::abs(dx * (middle.y - a.y) - dy * (middle.x - a.x)) /
                           std::max(length, 1e-12 * mSampling.size);
        // Directions have the same sense all along a line: opposite ones tell of a turn back. A
        // line that is seen as a point has no direction.
        const bool isSmooth =
            a.tx * b.tx + a.ty * b.ty > 0.98 || (depth > 10 && length < 0.1 * mSampling.flatness);
        const bool isFlat = off < mSampling.flatness &&
                            bowBetween(a, b) < 1.3 * mSampling.flatness &&
                            length < 0.02 * mSampling.size && isSmooth;
        if (depth > 24 || (isFlat && depth > 2)) {
            points.push_back(b);
            return;
        }
        refine({range[0], half}, a, middle, depth + 1, points);
        refine({half, range[1]}, middle, b, depth + 1, points);
    }

  private:
    const At& mAt;
    const CurveSampling& mSampling;
};

}  // namespace bandvox

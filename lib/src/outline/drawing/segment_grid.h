#pragma once

#include "outline/drawing/curve.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace bandvox {

/// The part of a curve from a point to the next.
struct CurveSegment {
    std::uint32_t curve, index;
};

/// Segments of all curves by the squares of the page that they touch.
class SegmentGrid {
  public:
    SegmentGrid(std::span<const Curve> curves, double cell) : mCurves(curves), mCell(cell) {
        for (std::uint32_t c = 0; c < curves.size(); ++c) {
            for (std::uint32_t i = 0; i + 1 < curves[c].points.size(); ++i) add({c, i});
        }
    }

    const CurvePoint& start(const CurveSegment& s) const {
        return mCurves[s.curve].points[s.index];
    }
    const CurvePoint& end(const CurveSegment& s) const {
        return mCurves[s.curve].points[s.index + 1];
    }
    const std::unordered_map<std::uint64_t, std::vector<CurveSegment>>& cells() const {
        return mCells;
    }

    /// Visits the segments around a place, at least those that are nearer than a cell is wide;
    /// some more than once.
    template <class Visit>
    void visitNear(double x, double y, const Visit& visit) const {
        const std::int64_t i = indexOf(x), j = indexOf(y);
        for (int near = 0; near < 9; ++near) {
            const auto found = mCells.find(key(i + near % 3 - 1, j + near / 3 - 1));
            if (found == mCells.end()) continue;
            for (const CurveSegment& segment : found->second) visit(segment);
        }
    }

  private:
    std::int64_t indexOf(double x) const {
        return static_cast<std::int64_t>(std::floor(x / mCell));
    }
    static std::uint64_t key(std::int64_t i, std::int64_t j) {
        return static_cast<std::uint64_t>(i) << 32U ^ (static_cast<std::uint64_t>(j) & 0xFFFFFFFFU);
    }

    void add(const CurveSegment& s) {
        const CurvePoint& a = start(s);
        const CurvePoint& b = end(s);
        const std::int64_t i1 = indexOf(std::max(a.x, b.x)), j1 = indexOf(std::max(a.y, b.y));
        for (std::int64_t i = indexOf(std::min(a.x, b.x)); i <= i1; ++i) {
            for (std::int64_t j = indexOf(std::min(a.y, b.y)); j <= j1; ++j) {
                mCells[key(i, j)].push_back(s);
            }
        }
    }

    std::span<const Curve> mCurves;
    double mCell;
    std::unordered_map<std::uint64_t, std::vector<CurveSegment>> mCells;
};

}  // namespace bandvox

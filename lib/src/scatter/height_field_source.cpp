#include "core/words.h"
#include "scatter/cubic_basis.h"
#include "source/patch_source.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/height_field_source.h>
#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// A polynomial of degree 3 on [0, 1] by its Bézier ordinates: the value and the derivative.
std::array<double, 2> bezierAt(const std::array<double, 4>& c, double t) {
    const double s = 1 - t;
    return {s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3],
            3 * (s * s * (c[1] - c[0]) + 2 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]))};
}

/// A cell of the surface, over a rectangle.
class HeightPatch final : public Patch {
  public:
    HeightPatch(const Rectangle& cell, const std::array<double, 16>& ordinates)
        : mCell(cell), mOrdinates(ordinates) {}

    PatchPoint at(double u, double v) const override {
        std::array<double, 4> value{};
        std::array<double, 4> slope{};
        for (std::size_t a = 0; a < 4; ++a) {
            const auto along = bezierAt({mOrdinates[4 * a], mOrdinates[4 * a + 1],
                                         mOrdinates[4 * a + 2], mOrdinates[4 * a + 3]},
                                        v);
            value[a] = along[0];
            slope[a] = along[1];
        }
        const auto height = bezierAt(value, u);
        return {Vec3d(mCell.x0 + u * mCell.width(), mCell.y0 + v * mCell.height(), height[0]),
                Vec3d(mCell.width(), 0, height[1]),
                Vec3d(0, mCell.height(), bezierAt(slope, u)[0])};
    }

    openvdb::BBoxd bounds(const ParameterCell& cell) const override {
        const auto [low, high] = std::minmax_element(mOrdinates.begin(), mOrdinates.end());
        return {
            Vec3d(mCell.x0 + cell.u0 * mCell.width(), mCell.y0 + cell.v0 * mCell.height(), *low),
            Vec3d(mCell.x0 + cell.u1 * mCell.width(), mCell.y0 + cell.v1 * mCell.height(), *high)};
    }

  private:
    Rectangle mCell;
    std::array<double, 16> mOrdinates;
};

/// What is between a border curve of a cell and the base: u along the border, v upwards.
class WallPatch final : public Patch {
  public:
    /// From `from` to `to`, places at the base, counter-clockwise around the solid.
    WallPatch(const Vec3d& from, const Vec3d& to, const std::array<double, 4>& ordinates)
        : mFrom(from), mStep(to - from), mOrdinates(ordinates) {}

    PatchPoint at(double u, double v) const override {
        const auto height = bezierAt(mOrdinates, u);
        const double tall = height[0] - mFrom[2];
        return {mFrom + u * mStep + Vec3d(0, 0, v * tall), mStep + Vec3d(0, 0, v * height[1]),
                Vec3d(0, 0, tall)};
    }

    openvdb::BBoxd bounds(const ParameterCell& cell) const override {
        const double top = *std::max_element(mOrdinates.begin(), mOrdinates.end());
        const Vec3d a = mFrom + cell.u0 * mStep;
        const Vec3d b = mFrom + cell.u1 * mStep;
        openvdb::BBoxd box(openvdb::math::minComponent(a, b), openvdb::math::maxComponent(a, b));
        box.expand(Vec3d(a[0], a[1], top));
        return box;
    }

  private:
    Vec3d mFrom, mStep;
    std::array<double, 4> mOrdinates;
};

Rectangle cellOfSurface(const BsplineSurface& surface, int i, int j) {
    const Rectangle& r = surface.rectangle();
    const int nx = surface.cells()[0];
    const int ny = surface.cells()[1];
    const auto x = [&](int k) { return k == nx ? r.x1 : r.x0 + r.width() * k / nx; };
    const auto y = [&](int k) { return k == ny ? r.y1 : r.y0 + r.height() * k / ny; };
    return {x(i), y(j), x(i + 1), y(j + 1)};
}

/// The area of a patch by a product rule of Gauss points.
double areaOf(const Patch& patch) {
    double area = 0;
    constexpr int kRule = 5;
    for (const IntervalPoint& u : intervalRule(kRule)) {
        for (const IntervalPoint& v : intervalRule(kRule)) {
            const PatchPoint p = patch.at(u.position, v.position);
            area += u.weight * v.weight * p.du.cross(p.dv).length();
        }
    }
    return area;
}

void appendWalls(const BsplineSurface& surface, double base, int column, PatchList& patches) {
    const auto [nx, ny] = surface.cells();
    const auto add = [&](double x0, double y0, double x1, double y1,
                         const std::array<double, 4>& ordinates) {
        patches.push_back(
            std::make_unique<WallPatch>(Vec3d(x0, y0, base), Vec3d(x1, y1, base), ordinates));
    };
    for (int i = 0; i < nx; ++i) {
        const auto front = surface.bezierOrdinates(i, 0, column);
        const Rectangle f = cellOfSurface(surface, i, 0);
        add(f.x0, f.y0, f.x1, f.y0, {front[0], front[4], front[8], front[12]});
        const auto back = surface.bezierOrdinates(i, ny - 1, column);
        const Rectangle b = cellOfSurface(surface, i, ny - 1);
        add(b.x1, b.y1, b.x0, b.y1, {back[15], back[11], back[7], back[3]});
    }
    for (int j = 0; j < ny; ++j) {
        const auto right = surface.bezierOrdinates(nx - 1, j, column);
        const Rectangle r = cellOfSurface(surface, nx - 1, j);
        add(r.x1, r.y0, r.x1, r.y1, {right[12], right[13], right[14], right[15]});
        const auto left = surface.bezierOrdinates(0, j, column);
        const Rectangle l = cellOfSurface(surface, 0, j);
        add(l.x0, l.y1, l.x0, l.y0, {left[3], left[2], left[1], left[0]});
    }
}

/// The lowest and the highest ordinate.
std::array<double, 2> ordinateRange(const BsplineSurface& surface, int column) {
    std::array<double, 2> range{std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::lowest()};
    const auto [nx, ny] = surface.cells();
    for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < ny; ++j) {
            for (const double z : surface.bezierOrdinates(i, j, column)) {
                range = {std::min(range[0], z), std::max(range[1], z)};
            }
        }
    }
    return range;
}

using Ordinates = std::array<double, 16>;  // of a patch, [x][y]

/// Both halves of four ordinates that are `stride` apart, by de Casteljau's rule.
void halve(const Ordinates& whole, std::size_t first, std::size_t stride, Ordinates& low,
           Ordinates& high) {
    std::array<double, 4> c{};
    for (std::size_t k = 0; k < 4; ++k) c[k] = whole[first + k * stride];
    for (std::size_t k = 0; k < 4; ++k) {
        low[first + k * stride] = c[0];
        high[first + (3 - k) * stride] = c[3 - k];
        for (std::size_t i = 0; i + k + 1 < 4; ++i) c[i] = (c[i] + c[i + 1]) / 2;
    }
}

std::array<Ordinates, 4> quarters(const Ordinates& patch) {
    Ordinates left{}, right{};
    for (std::size_t b = 0; b < 4; ++b) halve(patch, b, 4, left, right);
    std::array<Ordinates, 4> parts{};
    for (std::size_t a = 0; a < 4; ++a) {
        halve(left, 4 * a, 1, parts[0], parts[1]);
        halve(right, 4 * a, 1, parts[2], parts[3]);
    }
    return parts;
}

double lowestOf(const Ordinates& patch) {
    return *std::min_element(patch.begin(), patch.end());
}

/// How far the surface goes down, and if `sign` is -1, how far up, to 1e-9 of the range of its
/// ordinates: parts that may go farther than any place that is known are divided.
double extremeHeight(const BsplineSurface& surface, int column, double sign) {
    const auto [low, high] = ordinateRange(surface, column);
    constexpr double kNear = 1e-9;
    const double enough = kNear * (high - low);
    double lowest = sign > 0 ? high : -low;
    std::vector<Ordinates> parts;
    const auto look = [&](const Ordinates& patch) {
        lowest = std::min({lowest, patch[0], patch[3], patch[12], patch[15]});
        if (lowestOf(patch) < lowest - enough) parts.push_back(patch);
    };
    const auto [nx, ny] = surface.cells();
    for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < ny; ++j) {
            parts.clear();
            Ordinates whole = surface.bezierOrdinates(i, j, column);
            for (double& ordinate : whole) ordinate *= sign;
            look(whole);
            while (!parts.empty()) {
                const Ordinates patch = parts.back();
                parts.pop_back();
                if (lowestOf(patch) >= lowest - enough) continue;
                for (const Ordinates& quarter : quarters(patch)) look(quarter);
            }
        }
    }
    return sign * lowest;
}

}  // namespace

double heightBelow(const BsplineSurface& surface, double margin, int column) {
    const auto [low, high] = ordinateRange(surface, column);
    const Rectangle& r = surface.rectangle();
    const double tall = high > low ? high - low : std::min(r.width(), r.height());
    return low - margin * tall;
}

std::unique_ptr<BoundarySource> makeHeightFieldSource(const std::string& name,
                                                      const BsplineSurface& surface, double base,
                                                      int column) {
    const double lowest = extremeHeight(surface, column, 1);
    if (!(lowest > base)) {
        throw Error(ErrorKind::Usage, "the base at " + inFull(base) +
                                          " is not below the surface, which goes down to " +
                                          inFull(lowest) + "; expected a lower one");
    }
    PatchList patches;
    double volume = 0;
    const auto [nx, ny] = surface.cells();
    for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < ny; ++j) {
            const auto ordinates = surface.bezierOrdinates(i, j, column);
            const Rectangle cell = cellOfSurface(surface, i, j);
            // The integral of a Bézier patch is the mean of its ordinates.
            double sum = 0;
            for (const double z : ordinates) sum += z - base;
            volume += sum / 16 * cell.width() * cell.height();
            patches.push_back(std::make_unique<HeightPatch>(cell, ordinates));
        }
    }
    appendWalls(surface, base, column, patches);
    const Rectangle& r = surface.rectangle();
    patches.push_back(std::make_unique<QuadPatch>(Vec3d(r.x0, r.y0, base), Vec3d(r.x0, r.y1, base),
                                                  Vec3d(r.x1, r.y1, base),
                                                  Vec3d(r.x1, r.y0, base)));
    const openvdb::BBoxd bounds({r.x0, r.y0, base},
                                {r.x1, r.y1, extremeHeight(surface, column, -1)});
    double area = 0;
    for (const auto& patch : patches) area += areaOf(*patch);
    return std::make_unique<PatchSource>(name, std::move(patches), volume, area, bounds);
}

}  // namespace bandvox

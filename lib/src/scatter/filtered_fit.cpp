#include "scatter/filter_cascade.h"
#include "scatter/triangulate_places.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/filtered_fit.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

/// Where a sample takes its value: up to three points, with weights.
struct SampleShare {
    std::array<std::size_t, 3> point{};
    std::array<double, 3> weight{};
};

/// Samples of a function that is linear on triangles, row by row along x.
class TriangleSampler {
  public:
    explicit TriangleSampler(const ScatteredPoints& points, const Rectangle& rectangle);

    /// The value at a place, from values at the points.
    double at(double x, double y, const std::vector<double>& values);

  private:
    SampleShare inside(double x, double y, std::size_t triangle, bool& isInside) const;
    SampleShare nearest(double x, double y) const;

    const ScatteredPoints& mPoints;
    std::vector<std::array<std::size_t, 3>> mTriangles;
    std::vector<std::array<std::size_t, 2>> mBorder;
    // A coarse grid over the rectangle lists the triangles that each of its cells may meet.
    Rectangle mRectangle;
    int mSide = 1;
    std::vector<std::vector<std::size_t>> mCells;

    std::size_t cellIndex(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(mSide) +
               static_cast<std::size_t>(j);
    }
    int cellAlong(double place, double low, double size) const {
        return std::clamp(static_cast<int>((place - low) / size * mSide), 0, mSide - 1);
    }
};

TriangleSampler::TriangleSampler(const ScatteredPoints& points, const Rectangle& rectangle)
    : mPoints(points), mTriangles(triangulatePlaces(points.x, points.y)), mRectangle(rectangle) {
    if (mTriangles.empty()) {
        throw Error(ErrorKind::Input,
                    "the points are all on a line; expected such as make triangles");
    }
    mSide = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(mTriangles.size()))), 1, 512);
    mCells.resize(static_cast<std::size_t>(mSide) * static_cast<std::size_t>(mSide));
    std::vector<std::array<std::size_t, 2>> edges;
    for (std::size_t t = 0; t < mTriangles.size(); ++t) {
        double x0 = std::numeric_limits<double>::max();
        double y0 = x0;
        double x1 = -x0;
        double y1 = -x0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t p = mTriangles[t][k];
            x0 = std::min(x0, points.x[p]);
            x1 = std::max(x1, points.x[p]);
            y0 = std::min(y0, points.y[p]);
            y1 = std::max(y1, points.y[p]);
            edges.push_back({p, mTriangles[t][(k + 1) % 3]});
        }
        for (int i = cellAlong(x0, rectangle.x0, rectangle.width());
             i <= cellAlong(x1, rectangle.x0, rectangle.width()); ++i) {
            for (int j = cellAlong(y0, rectangle.y0, rectangle.height());
                 j <= cellAlong(y1, rectangle.y0, rectangle.height()); ++j) {
                mCells[cellIndex(i, j)].push_back(t);
            }
        }
    }
    // An edge of the hull is there once, any other in both directions.
    std::sort(edges.begin(), edges.end());
    for (const auto& edge : edges) {
        if (!std::binary_search(edges.begin(), edges.end(), std::array{edge[1], edge[0]})) {
            mBorder.push_back(edge);
        }
    }
}

/// Section 3.1: barycentric coordinates, which are all positive inside.
SampleShare TriangleSampler::inside(double x, double y, std::size_t triangle,
                                    bool& isInside) const {
    SampleShare share{mTriangles[triangle], {}};
    double total = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = share.point[(k + 1) % 3];
        const std::size_t b = share.point[(k + 2) % 3];
        share.weight[k] = (mPoints.x[b] - mPoints.x[a]) * (y - mPoints.y[a]) -
                          (mPoints.y[b] - mPoints.y[a]) * (x - mPoints.x[a]);
        total += share.weight[k];
    }
    isInside = total > 0;
    for (double& weight : share.weight) {
        weight /= total;
        // A place on an edge belongs to both triangles; rounding must not make it belong to none.
        isInside = isInside && weight >= -1e-12;
    }
    return share;
}

SampleShare TriangleSampler::nearest(double x, double y) const {
    SampleShare best;
    double least = std::numeric_limits<double>::max();
    for (const auto& [a, b] : mBorder) {
        const double dx = mPoints.x[b] - mPoints.x[a];
        const double dy = mPoints.y[b] - mPoints.y[a];
        const double along =
            ((x - mPoints.x[a]) * dx + (y - mPoints.y[a]) * dy) / (dx * dx + dy * dy);
        const double t = std::clamp(along, 0.0, 1.0);
        const double away = std::hypot(mPoints.x[a] + t * dx - x, mPoints.y[a] + t * dy - y);
        if (away >= least) continue;
        least = away;
        best = {{a, b, b}, {1 - t, t, 0}};
    }
    return best;
}

double TriangleSampler::at(double x, double y, const std::vector<double>& values) {
    const int i = cellAlong(x, mRectangle.x0, mRectangle.width());
    const int j = cellAlong(y, mRectangle.y0, mRectangle.height());
    const auto sum = [&](const SampleShare& share) {
        double total = 0;
        for (std::size_t k = 0; k < 3; ++k) total += share.weight[k] * values[share.point[k]];
        return total;
    };
    for (const std::size_t triangle : mCells[cellIndex(i, j)]) {
        bool isInside = false;
        const SampleShare share = inside(x, y, triangle, isInside);
        if (isInside) return sum(share);
    }
    return sum(nearest(x, y));
}

/// Section 5: control points of the cubic spline through 2^k + 1 values, the two outermost ones on
/// each side equal.
std::vector<double> interpolateLine(const std::vector<double>& values) {
    const std::size_t count = values.size();
    // (c[i] + 4 c[i+1] + c[i+2]) / 6 = values[i], by elimination.
    std::vector<double> control(count + 2), factor(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double corner = (i == 0 ? 1 : 0) + (i + 1 == count ? 1 : 0);
        const double diagonal = 4 + corner - (i == 0 ? 0 : factor[i - 1]);
        factor[i] = 1 / diagonal;
        control[i + 1] = (6 * values[i] - (i == 0 ? 0 : control[i])) / diagonal;
    }
    for (std::size_t i = count; i-- > 1;) control[i] -= factor[i - 1] * control[i + 1];
    control.front() = control[1];
    control.back() = control[count];
    return control;
}

double coordinate(double low, double size, std::size_t i, std::size_t cells) {
    return low + size * static_cast<double>(i) / static_cast<double>(cells);
}

/// One surface f^kl from what is lacking at the points.
BsplineSurface filteredSurface(TriangleSampler& sampler, const Rectangle& r, std::size_t samples,
                               std::size_t cells, const std::vector<double>& lacking) {
    std::vector<std::vector<double>> columns;  // control points along y, for each x that is left
    RowCascade cascade(samples, cells, [&](const std::vector<double>& row) {
        columns.push_back(interpolateLine(row));
    });
    std::vector<double> row(samples + 1);
    for (std::size_t i = 0; i <= samples; ++i) {
        for (std::size_t j = 0; j <= samples; ++j) {
            row[j] = sampler.at(coordinate(r.x0, r.width(), i, samples),
                                coordinate(r.y0, r.height(), j, samples), lacking);
        }
        cascade.push(filterLine(row, cells));
    }
    const auto count = static_cast<int>(cells);
    BsplineSurface surface(r, {count, count}, 1);
    const auto control = surface.control(0);
    std::vector<double> line(columns.size());
    for (std::size_t j = 0; j < cells + 3; ++j) {
        for (std::size_t i = 0; i < line.size(); ++i) line[i] = columns[i][j];
        const std::vector<double> made = interpolateLine(line);
        for (std::size_t i = 0; i < made.size(); ++i) control[i * (cells + 3) + j] = made[i];
    }
    return surface;
}

/// Section 3.2: as many samples as bring one near each point close to its value.
std::size_t samplesFor(TriangleSampler& sampler, const ScatteredPoints& points, const Rectangle& r,
                       const std::vector<double>& values, double allowed,
                       const FilteredFitOptions& options) {
    std::size_t samples = std::size_t(2) << static_cast<unsigned>(options.levels);
    const std::size_t most = std::size_t(1) << static_cast<unsigned>(options.finest);
    for (; samples < most; samples *= 2) {
        double farthest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto nearest = [&](double place, double low, double size) {
                const double step = size / static_cast<double>(samples);
                return low + step * std::round((place - low) / step);
            };
            const double found = sampler.at(nearest(points.x[i], r.x0, r.width()),
                                            nearest(points.y[i], r.y0, r.height()), values);
            farthest = std::max(farthest, std::abs(found - values[i]));
        }
        if (farthest <= allowed) break;
    }
    return samples;
}

void checkFilteredOptions(const FilteredFitOptions& options) {
    const bool isSound = options.levels >= 1 && options.levels <= 9 && options.passes >= 1 &&
                         options.tolerance >= 0 && options.closeness >= 0 &&
                         options.closeness <= 1 && options.finest > options.levels &&
                         options.finest <= 12;
    if (isSound) return;
    throw Error(ErrorKind::Usage, "a fit by filtering of " + std::to_string(options.levels) +
                                      " levels with 2^" + std::to_string(options.finest) +
                                      " samples; expected 1 to 9 levels, and more samples than "
                                      "control points, up to 2^12");
}

}  // namespace

SurfaceFit fitByFiltering(const ScatteredPoints& points, const FilteredFitOptions& options,
                          Progress& progress) {
    checkFilteredOptions(options);
    const MergedPoints merged = mergeDuplicates(points, options.tolerance);
    const ScatteredPoints& places = merged.points;
    const Rectangle r = boundingRectangle(places);
    if (places.columns != 1) {
        throw Error(ErrorKind::Usage, "a fit by filtering of " + std::to_string(places.columns) +
                                          " columns of values; expected one");
    }
    TriangleSampler sampler(places, r);
    std::vector<double> lacking = places.values;
    const auto [low, high] = std::minmax_element(lacking.begin(), lacking.end());
    const double range = *high > *low ? *high - *low : 1;
    const std::size_t samples =
        samplesFor(sampler, places, r, lacking, options.closeness * range, options);
    SurfaceFit fit;
    fit.points = places.size();
    fit.duplicates = merged.duplicates;
    for (int level = 1; level <= options.levels; ++level) {
        const auto cells = std::size_t(1) << static_cast<unsigned>(level);
        BsplineSurface sum(r, {static_cast<int>(cells), static_cast<int>(cells)}, 1);
        FitLevel report{level, sum.cells(), 0, 0};
        for (int pass = 0; pass < options.passes; ++pass) {
            progress.throwIfInterrupted();
            const BsplineSurface part = filteredSurface(sampler, r, samples, cells, lacking);
            sum.add(part);
            double change = 0;
            double squares = 0;
            report.largest = 0;
            for (std::size_t i = 0; i < places.size(); ++i) {
                const double value = part.value(places.x[i], places.y[i]);
                lacking[i] -= value;
                change = std::max(change, std::abs(value) / range);
                report.largest = std::max(report.largest, std::abs(lacking[i]) / range);
                squares += lacking[i] * lacking[i];
            }
            report.rms = std::sqrt(squares / static_cast<double>(places.size())) / range;
            if (change <= options.tolerance) break;
        }
        fit.levels.push_back(std::move(sum));
        fit.report.push_back(report);
    }
    return fit;
}

}  // namespace bandvox

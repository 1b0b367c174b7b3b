#include "scatter/volume_problem.h"

#include "core/words.h"
#include "scatter/column_scale.h"
#include "scatter/fit_limits.h"

#include <bandvox/core/error.h>

#include <cmath>
#include <string>
#include <utility>

namespace bandvox {

void checkVolumeOptions(const FitVolumeOptions& options) {
    checkFitLimits({"a volume's fit", options.tolerance, options.noise, options.maxLevel,
                    kFinestSpaceLevel, options.tension});
}

SplineVolumeParts makeUnitVolume(const MergedPoints& merged, SpaceColumns& columns) {
    const ScatteredPoints& points = merged.points;
    SplineVolumeParts parts;
    const std::array<const std::vector<double>*, 3> axes{&points.x, &points.y, &points.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(axes[axis]->begin(), axes[axis]->end());
        parts.origin[axis] = *low;
        parts.size[axis] = *high - *low;
    }
    parts.longest = *std::max_element(parts.size.begin(), parts.size.end());
    if (!(parts.longest > 0) || !std::isfinite(parts.longest)) {
        throw Error(ErrorKind::Input, "the points' box has a longest side of " +
                                          inShort(parts.longest) +
                                          "; expected two places at least, and a finite box");
    }
    std::vector<std::array<double, 3>> at(points.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = parts.unitPlace({points.x[i], points.y[i], points.z[i]});
    }
    parts.sorted =
        std::make_unique<const SortedSpacePoints>(sortSpacePoints(std::move(at), merged.weight));
    for (int column = 0; column < points.columns; ++column) {
        const ColumnScale scale = scaleOfColumn(points, column);
        parts.mean.push_back(scale.mean);
        parts.range.push_back(scale.range);
        auto& values = columns.emplace_back(points.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = (points.value(parts.points().origin[i], column) - scale.mean) / scale.range;
        }
    }
    return parts;
}

double spacingOf(const SortedSpacePoints& points, int level, const Progress& progress) {
    constexpr std::size_t kMostAsked = 20000;
    constexpr double kMost = 0.9;
    const OccupiedCells cells(points, level, progress);
    const std::size_t count = std::min(points.size(), kMostAsked);
    std::vector<double> nearest(count);
    parallelFor(static_cast<std::int64_t>(count), [&](std::int64_t k) {
        const auto i = static_cast<std::size_t>(k);
        nearest[i] = cells.nearest(i * points.size() / count);
    });
    const auto at =
        nearest.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(count - 1) * kMost);
    std::nth_element(nearest.begin(), at, nearest.end());
    return *at;
}

}  // namespace bandvox

// How far can the sampling error that is stated be trusted? docs/math/sampled-route.md shows it.

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr int kSolids = 400;  // of each kind

// The true error over D, the largest difference from the density of every second sample.
double errorOverDifference(const BoundarySource& boundary, const FieldSource& field,
                           double voxelSize, int oversample) {
    const ExponentialFilter& filter = kFilters[0];
    FieldDensityOptions options;
    options.density.voxelSize = voxelSize;
    options.density.filter = filter;
    options.density.tolerance = kTolerance;
    options.oversample = oversample;
    const DensityResult sampled = fieldToDensity(field, options);
    const DensityResult truth = exactDensity(boundary, filter, voxelSize);
    // What is stated is 2 D.
    return compare(*sampled.grid, *truth.grid).largest / (0.5 * sampled.metadata.samplingError);
}

// A solid whose size and place come from random numbers in [0, 1).
struct Kind {
    std::string name;
    double least, most;  // side, radius or thickness, voxels
};
const Kind kKinds[] = {
    {"box", 8, 24}, {"ball", 1, 15}, {"plate", 3.6, 4.6}, {"plate", 2, 3}, {"plate", 1, 2},
};

double measureOne(const Kind& kind, int number, int oversample) {
    std::mt19937 random(static_cast<std::uint32_t>(number));
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    const double x = between(0, 1);
    const double y = between(0, 1);
    const Vec3d place(x, y, between(0, 1));
    if (kind.name == "ball") {
        const double radius = between(kind.least, kind.most);
        const auto boundary = makeShapeBoundary("shape:sphere");  // its radius is 1
        const auto field = makeShapeField("shape:sphere");
        const Vec3d shift = place / radius;
        return errorOverDifference(ShiftedCopies(*boundary, {shift}), ShiftedField(*field, shift),
                                   1 / radius, oversample);
    }
    Box box{Vec3d(0.0), place};
    for (int axis = 0; axis < 3; ++axis) {
        const bool isThin = kind.name == "box" || axis == number % 3;
        box.half[axis] = 0.5 * (isThin ? between(kind.least, kind.most) : between(8, 16));
    }
    return errorOverDifference(box.boundary(), BoxField(box), 1, oversample);
}

}  // namespace

void measureStatedError(const Folder& folder) {
    Table table = folder.table("stated_error",
                               "solid,least_size,most_size,samples_per_voxel,number,mean_ratio,"
                               "largest_ratio,above_stated");
    for (const Kind& kind : kKinds) {
        for (const int oversample : {2, 4, 8}) {
            std::vector<double> ratios(kSolids);
            parallelFor(kSolids, [&](std::int64_t i) {
                ratios[i] = measureOne(kind, static_cast<int>(i), oversample);
            });
            const double sum = std::accumulate(ratios.begin(), ratios.end(), 0.0);
            table.add(kind.name, kind.least, kind.most, oversample, kSolids, sum / kSolids,
                      *std::max_element(ratios.begin(), ratios.end()),
                      std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 2; }));
        }
    }
}

}  // namespace bandvox::experiments

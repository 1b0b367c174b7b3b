// How far can the sampling error that is stated be trusted? docs/math/sampled-route.md shows it.

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
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

// Solids whose size, place and, if turned, direction are random.
struct Kind {
    std::string name;
    int thinAxes;  // of a box, whose other sides are 8 to 16 voxels; 0 is a ball
    bool isTurned;
    double least, most;  // thin side or radius, voxels
};
const Kind kKinds[] = {
    {"box", 3, false, 8, 24},        {"ball", 0, false, 1, 15},     {"ball", 0, false, 0.5, 1},
    {"plate", 1, false, 3.6, 4.6},   {"plate", 1, false, 2, 3},     {"plate", 1, false, 1, 2},
    {"rod", 2, false, 2, 3},         {"rod", 2, false, 1, 2},       {"turned plate", 1, true, 2, 3},
    {"turned plate", 1, true, 1, 2}, {"turned rod", 2, true, 1, 2},
};

double measureOne(const Kind& kind, int number, int oversample) {
    std::mt19937 random(static_cast<std::uint32_t>(number));
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    const double x = between(0, 1);
    const double y = between(0, 1);
    const Vec3d place(x, y, between(0, 1));
    if (kind.thinAxes == 0) {
        const double radius = between(kind.least, kind.most);
        const auto boundary = makeShapeBoundary("shape:sphere");  // its radius is 1
        const auto field = makeShapeField("shape:sphere");
        const Vec3d shift = place / radius;
        return errorOverDifference(ShiftedCopies(*boundary, {shift}), ShiftedField(*field, shift),
                                   1 / radius, oversample);
    }
    Box box{Vec3d(0.0), place};
    for (int i = 0; i < 3; ++i) {
        // A plate's thin side is along each axis in turn.
        const bool isThin =
            kind.thinAxes == 2 ? i != number % 3 : kind.thinAxes == 3 || i == number % 3;
        box.half[i] = 0.5 * (isThin ? between(kind.least, kind.most) : between(8, 16));
    }
    if (kind.isTurned) {
        const double a = between(-1, 1);
        const double b = between(-1, 1);
        const Vec3d axis(a, b, between(0.1, 1));
        box.rotation.setToRotation(axis.unit(), between(0, std::numbers::pi));
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

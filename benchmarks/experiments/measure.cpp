#include "measure.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <algorithm>
#include <cmath>

namespace bandvox::experiments {

DensityResult exactDensity(const BoundarySource& solid, const ExponentialFilter& filter,
                           double voxelSize) {
    DensityOptions options;
    options.voxelSize = voxelSize;
    options.filter = filter;
    options.tolerance = kTolerance;
    return surfaceToDensity(solid, options);
}

DensityError compare(const openvdb::FloatGrid& density, const openvdb::FloatGrid& truth) {
    openvdb::CoordBBox box = density.evalActiveVoxelBoundingBox();
    box.expand(truth.evalActiveVoxelBoundingBox());
    const auto found = density.getConstAccessor();
    const auto expected = truth.getConstAccessor();
    DensityError error;
    double squares = 0;
    std::int64_t edge = 0;
    for (auto voxel = box.begin(); voxel; ++voxel) {
        const double value = expected.getValue(*voxel);
        const double difference = found.getValue(*voxel) - value;
        error.largest = std::max(error.largest, std::abs(difference));
        squares += difference * difference;
        if (value > 0.05 && value < 0.95) ++edge;
    }
    error.rms = std::sqrt(squares / static_cast<double>(edge));
    return error;
}

DensityReader::DensityReader(const openvdb::FloatGrid::Ptr& grid, const ExponentialFilter& filter)
    : mReconstruction(makeBrickReconstruction(
          grid, {.filter = filter, .tolerance = kReadingTolerance, .cacheBytes = 512U << 20})),
      mProbe(mReconstruction->probe()) {}

std::optional<double> DensityReader::firstBelow(double iso, const openvdb::Vec3d& start,
                                                const openvdb::Vec3d& direction,
                                                double farthest) const {
    return experiments::firstBelow([&](double t) { return mProbe->value(start + t * direction); },
                                   iso, 0, farthest);
}

std::optional<double> firstBelow(const std::function<double(double)>& function, double level,
                                 double low, double high) {
    constexpr double kStep = 1.0 / 16;
    double above = low;
    for (double t = low;; t = std::min(t + kStep, high)) {
        if (function(t) < level) {
            double below = t;
            while (below - above > 1e-7) {
                const double middle = 0.5 * (above + below);
                (function(middle) < level ? below : above) = middle;
            }
            return 0.5 * (above + below);
        }
        if (t >= high) return std::nullopt;
        above = t;
    }
}

double solveRising(const std::function<double(double)>& function, double level, double low,
                   double high) {
    // False position with the Illinois rule: the function is dear, and smooth.
    double atLow = function(low) - level;
    double atHigh = function(high) - level;
    if (atLow > 0 || atHigh < 0) {
        throw Error(ErrorKind::Runtime, "the level " + std::to_string(level) +
                                            " is not passed between " + std::to_string(low) +
                                            " and " + std::to_string(high));
    }
    int side = 0;
    double last = low;
    for (int i = 0; i < 60 && high - low > 1e-4; ++i) {
        const double place = (low * atHigh - high * atLow) / (atHigh - atLow);
        const double value = function(place) - level;
        if (value < 0) {
            low = place;
            atLow = value;
            if (side == -1) atHigh /= 2;
            side = -1;
        } else {
            high = place;
            atHigh = value;
            if (side == 1) atLow /= 2;
            side = 1;
        }
        if (std::abs(place - last) < 1e-5) return place;
        last = place;
    }
    return 0.5 * (low + high);
}

}  // namespace bandvox::experiments

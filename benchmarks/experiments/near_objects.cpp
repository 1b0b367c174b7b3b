// How much do near objects distort each other?

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/source/shapes.h>

#include <cmath>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr double kIso = 0.5;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Two half-spaces that face each other, by the closed form. How far the surface stands outside the
// face of one of them, voxels; nothing if the surfaces have merged.
std::optional<double> plateDisplacement(const ExponentialFilter& filter, double gap) {
    const auto density = [&](double outside) {
        return halfSpaceDensity(filter, outside) + halfSpaceDensity(filter, gap - outside);
    };
    return firstBelow(density, kIso, -4, gap / 2);
}

// How far the surface of a ball stands outside of it where it faces the other, voxels.
std::optional<double> ballDisplacement(const ExponentialFilter& filter, double radius, double gap) {
    const auto ball = makeShapeBoundary("shape:sphere");  // its radius is 1
    const Vec3d shift(1 + gap / (2 * radius), 0, 0);
    const ShiftedCopies balls(*ball, {-shift, shift});
    const DensityReader reader(exactDensity(balls, filter, 1 / radius).grid, filter);
    const double inside = 0.5 * radius;
    const auto length = reader.firstBelow(kIso, Vec3d(radius - inside + gap / 2, 0, 0),
                                          Vec3d(-1, 0, 0), radius - inside + gap / 2);
    if (!length) return std::nullopt;
    return *length - (radius - inside);
}

double lonelyDisplacement(const ExponentialFilter& filter, double radius) {
    const auto ball = makeShapeBoundary("shape:sphere");
    const DensityReader reader(exactDensity(*ball, filter, 1 / radius).grid, filter);
    return *reader.firstBelow(kIso, Vec3d(0.0), Vec3d(1, 0, 0), 2 * radius) - radius;
}

// The widest gap at which two surfaces are one. `displacement` is nothing there.
template <typename Displacement>
double mergingGap(const Displacement& displacement) {
    double merged = 0;
    double apart = 8;
    while (apart - merged > 1e-3) {
        const double middle = 0.5 * (merged + apart);
        (displacement(middle) ? apart : merged) = middle;
    }
    return 0.5 * (merged + apart);
}

template <typename Displacement>
void sweep(Table& table, const std::string& objects, double radius, const ExponentialFilter& filter,
           double alone, const Displacement& displacement) {
    // Where the surfaces merge, and from there on in steps of a quarter of a voxel.
    const double merging = mergingGap(displacement);
    const auto add = [&](double gap) {
        const std::optional<double> moved = displacement(gap);
        table.add(objects, radius, filter.order, filter.cutoff, gap, moved ? *moved - alone : kNone,
                  alone, merging);
    };
    add(merging + 1e-3);
    for (double gap = 0.25 * std::ceil(4 * merging + 0.1); gap <= 10; gap += 0.25) add(gap);
}

}  // namespace

void measureNearObjects(const Folder& folder) {
    Table table = folder.table("near_objects",
                               "objects,radius,order,cutoff,gap,displacement,alone,merging_gap");
    for (const ExponentialFilter& filter : kFilters) {
        sweep(table, "plates", 0, filter, 0,
              [&](double gap) { return plateDisplacement(filter, gap); });
        for (const double radius : {4.0, 16.0}) {
            sweep(table, "balls", radius, filter, lonelyDisplacement(filter, radius),
                  [&](double gap) { return ballDisplacement(filter, radius, gap); });
        }
    }
}

}  // namespace bandvox::experiments

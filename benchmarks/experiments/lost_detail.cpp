// What does the cutoff cost in rounded corners and in thin parts?

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/source/shapes.h>

#include <cmath>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr double kIso = 0.5;
constexpr double kCubeHalf = 32;  // voxels; its corners do not feel each other
constexpr double kLong = 64;      // voxels; the ends of a rod are not felt in its middle

struct Sweep {
    double order;
    std::vector<double> cutoffs;  // as high as the lattice can hold
};
const Sweep kSweeps[] = {
    {2, {0.06, 0.08, 0.10, 0.12, 0.14, 0.16}},
    {4, {0.10, 0.13, 0.16, 0.19, 0.22, 0.25, 0.28}},
    {8, {0.12, 0.16, 0.20, 0.24, 0.28, 0.32, 0.35}},
};

// From the cube's middle, how far short of the true place the surface lies, voxels.
double shortfall(const DensityReader& cube, const Vec3d& direction) {
    const double truth = kCubeHalf * direction.length();
    const double from = 0.5 * truth;
    const Vec3d unit = direction.unit();
    return truth - from - *cube.firstBelow(kIso, from * unit, unit, truth);
}

void measureRounding(Table& table, const ExponentialFilter& filter) {
    const Box box{Vec3d(kCubeHalf)};
    const DensityReader cube(exactDensity(box.boundary(), filter, 1).grid, filter);
    table.add("corner", filter.order, filter.cutoff, shortfall(cube, Vec3d(1, 1, 1)));
    table.add("edge", filter.order, filter.cutoff, shortfall(cube, Vec3d(1, 1, 0)));
    table.add("face", filter.order, filter.cutoff, shortfall(cube, Vec3d(1, 0, 0)));
}

// The density in the middle of a solid whose centre is a voxel's.
double middleDensity(const BoundarySource& solid, const ExponentialFilter& filter,
                     double voxelSize) {
    return exactDensity(solid, filter, voxelSize).grid->tree().getValue(openvdb::Coord(0, 0, 0));
}

// The thinnest solids whose middle still reaches the iso-value.
void measureThinnest(Table& table, const ExponentialFilter& filter) {
    const double low = 0.1 / filter.cutoff;
    const double high = 1 / filter.cutoff;
    const auto plate = [&](double thickness) {
        return 1 - 2 * halfSpaceDensity(filter, thickness / 2);
    };
    const auto rod = [&](double thickness) {
        const Box box{Vec3d(thickness / 2, thickness / 2, kLong / 2)};
        return middleDensity(box.boundary(), filter, 1);
    };
    const auto ball = makeShapeBoundary("shape:sphere");  // its radius is 1
    const auto ballOf = [&](double diameter) { return middleDensity(*ball, filter, 2 / diameter); };
    table.add("plate", filter.order, filter.cutoff, solveRising(plate, kIso, low, high));
    table.add("square rod", filter.order, filter.cutoff, solveRising(rod, kIso, low, high));
    table.add("ball", filter.order, filter.cutoff, solveRising(ballOf, kIso, low, high));
}

}  // namespace

void measureLostDetail(const Folder& folder) {
    Table rounding = folder.table("rounding", "place,order,cutoff,shortfall");
    Table thinnest = folder.table("thinnest", "solid,order,cutoff,thickness");
    for (const Sweep& sweep : kSweeps) {
        for (const double cutoff : sweep.cutoffs) {
            measureRounding(rounding, {sweep.order, cutoff});
            measureThinnest(thinnest, {sweep.order, cutoff});
        }
    }
}

}  // namespace bandvox::experiments

#include "compare/test_surfaces.h"
#include "grid/summary_grids.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/compare/compare_grids.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox::compare_test {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

TEST(CompareGrids, EveryActiveVoxelCountsOnce) {
    for (const Coord& offset : {Coord(0), Coord(16, 0, -8), Coord(1, -2, 3)}) {
        const auto a = summary_grids::mixedGrid(Vec3d(0.5, 0.5, 0.25));
        const auto b = a->deepCopy();
        b->tree().setValue(Coord(10, 20, -3), 5.0F);
        b->tree().addTile(1, Coord(64, 16, -16), 0.25F, true);
        // The second's voxels are the first's, moved on.
        b->setTransform(a->transform().copy());
        b->transform().preTranslate(offset.asVec3d());

        double maximum = 0, sum = 0, absolute = 0, square = 0;
        std::int64_t count = 0;
        Coord at;
        for (int x = -40; x < 100; ++x) {
            for (int y = -40; y < 80; ++y) {
                for (int z = -50; z < 40; ++z) {
                    const Coord here(x, y, z);
                    if (!a->tree().isValueOn(here) && !b->tree().isValueOn(here - offset)) continue;
                    const double difference = double(b->tree().getValue(here - offset)) -
                                              double(a->tree().getValue(here));
                    if (std::abs(difference) > maximum) {
                        maximum = std::abs(difference);
                        at = here;
                    }
                    ++count;
                    sum += difference;
                    absolute += std::abs(difference);
                    square += difference * difference;
                }
            }
        }
        const GridDifference found = compareGrids(a, b);
        EXPECT_EQ(found.lattices,
                  offset == Coord(0) ? ComparedLattices::Same : ComparedLattices::Shifted);
        EXPECT_EQ(found.voxels, count);
        EXPECT_EQ(found.maximum, maximum);
        EXPECT_EQ(found.at, a->indexToWorld(at));
        EXPECT_EQ(std::abs(found.valueB - found.valueA), maximum);
        const auto n = static_cast<double>(count);
        EXPECT_NEAR(found.mean, sum / n, 1e-12);
        EXPECT_NEAR(found.meanAbsolute, absolute / n, 1e-12);
        EXPECT_NEAR(found.rms, std::sqrt(square / n), 1e-12);
        EXPECT_EQ(found.integralA, densityIntegral(*a));
        EXPECT_EQ(found.integralB, densityIntegral(*b));

        const GridDifference back = compareGrids(b, a);
        EXPECT_EQ(back.voxels, count);
        EXPECT_EQ(back.maximum, maximum);
        EXPECT_NEAR(back.mean, -found.mean, 1e-14);
        EXPECT_NEAR(back.rms, found.rms, 1e-14);
        EXPECT_EQ(back.integralA, found.integralB);
    }
}

TEST(CompareGrids, LargeTilesCountEachOfTheirVoxels) {
    const auto a = openvdb::FloatGrid::create(0.0F), b = openvdb::FloatGrid::create(0.0F);
    a->tree().addTile(3, Coord(0), 1.0F, true);
    b->tree().addTile(2, Coord(128, 0, 0), 0.5F, true);
    const GridDifference found = compareGrids(a, b);
    const double count = std::pow(4096.0, 3), tile = std::pow(128.0, 3);
    EXPECT_EQ(found.voxels, std::int64_t(4096) * 4096 * 4096);
    EXPECT_DOUBLE_EQ(found.mean, (0.5 * tile - count) / count);
    EXPECT_DOUBLE_EQ(found.rms, std::sqrt((count - tile + 0.25 * tile) / count));
    EXPECT_EQ(found.maximum, 1);
    EXPECT_EQ(found.at, Vec3d(0));
}

TEST(CompareGrids, IdenticalGridsDoNotDiffer) {
    const auto grid = summary_grids::mixedGrid();
    const GridDifference found = compareGrids(grid, grid);
    EXPECT_EQ(found.maximum, 0);
    EXPECT_EQ(found.rms, 0);
    EXPECT_EQ(found.mean, 0);
    EXPECT_GT(found.voxels, 3000);
}

TEST(CompareGrids, OneSolidOnTwoLatticesIsOneDensity) {
    const auto source = makeShapeBoundary("shape:torus");
    DensityOptions options;
    options.resolution = 32;
    const auto a = surfaceToDensity(*source, options).grid;
    // The same density, since its filter is the same in the world, on smaller voxels.
    options.resolution = 48;
    options.filter.cutoff *= 32.0 / 48;
    const auto b = surfaceToDensity(*source, options).grid;
    for (const auto& [first, second] : {std::pair(a, b), std::pair(b, a)}) {
        const GridDifference found = compareGrids(first, second);
        EXPECT_EQ(found.lattices, ComparedLattices::Resampled);
        EXPECT_LT(found.maximum, 5e-4);
        EXPECT_GT(found.voxels, 1000);
        EXPECT_NEAR(found.integralA, found.integralB, 1e-3 * found.integralA);
    }
    // A density that differs is told from it.
    options.filter.cutoff *= 0.9;
    EXPECT_GT(compareGrids(a, surfaceToDensity(*source, options).grid).maximum, 0.01);
}

TEST(CompareGrids, IsTheSameForAnyNumberOfThreads) {
    const auto a = summary_grids::mixedGrid(), b = a->deepCopy();
    b->setTransform(a->transform().copy());
    b->transform().preTranslate(Vec3d(3, 1, 0));
    GridDifference results[2];
    for (int i = 0; i < 2; ++i) {
        const ThreadLimit limit(i == 0 ? 1 : 4);
        results[i] = compareGrids(a, b);
    }
    EXPECT_EQ(results[0].mean, results[1].mean);
    EXPECT_EQ(results[0].rms, results[1].rms);
    EXPECT_EQ(results[0].at, results[1].at);
}

TEST(CompareGrids, RefusesWhatItCannotCompare) {
    const auto kindOf = [](const openvdb::FloatGrid::ConstPtr& a,
                           const openvdb::FloatGrid::ConstPtr& b) {
        try {
            compareGrids(a, b);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Interrupted;
    };
    const auto grid = summary_grids::mixedGrid();
    const auto empty = openvdb::FloatGrid::create(0.0F);
    EXPECT_EQ(kindOf(grid, grid), ErrorKind::Interrupted) << "this one works";
    EXPECT_EQ(kindOf(grid, nullptr), ErrorKind::Usage);
    EXPECT_EQ(kindOf(empty, empty), ErrorKind::Result);
    EXPECT_EQ(kindOf(grid, empty), ErrorKind::Interrupted) << "one of them has values";
    const auto broken = grid->deepCopy();
    broken->tree().setValue(Coord(1, 7, 3), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(kindOf(grid, broken), ErrorKind::Input);
    const auto bent = grid->deepCopy();
    bent->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(0), Vec3d(10)), 0.5, 10));
    EXPECT_EQ(kindOf(grid, bent), ErrorKind::Input);
    EXPECT_EQ(kindOf(bent, grid), ErrorKind::Input);
}

}  // namespace
}  // namespace bandvox::compare_test

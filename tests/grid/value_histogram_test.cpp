// The histogram against counting voxel by voxel.

#include "grid/summary_grids.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace bandvox {
namespace {

using openvdb::Coord;

TEST(ValueHistogram, CountsEveryVoxelOfTheBox) {
    const auto grid = summary_grids::mixedGrid();
    const ValueHistogram histogram = valueHistogram(*grid);
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    double low = 1, high = -1;
    for (auto voxel = box.begin(); voxel; ++voxel) {
        low = std::min<double>(low, grid->tree().getValue(*voxel));
        high = std::max<double>(high, grid->tree().getValue(*voxel));
    }
    EXPECT_EQ(histogram.low, low);
    EXPECT_EQ(histogram.high, high);
    std::array<double, ValueHistogram::kBins> active{}, inactive{};
    for (auto voxel = box.begin(); voxel; ++voxel) {
        const double part = (grid->tree().getValue(*voxel) - low) / (high - low);
        const int bin =
            std::min(static_cast<int>(part * ValueHistogram::kBins), ValueHistogram::kBins - 1);
        ++(grid->tree().isValueOn(*voxel) ? active : inactive)[bin];
    }
    EXPECT_EQ(histogram.active, active);
    EXPECT_EQ(histogram.inactive, inactive);
}

TEST(ValueHistogram, TakesBoxesWithMoreVoxelsThanCanBeVisited) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().setValue(Coord(0), 1.0F);
    grid->tree().setValue(Coord(999999), 2.0F);
    const ValueHistogram histogram = valueHistogram(*grid);
    EXPECT_EQ(histogram.inactive[0], 1e18 - 2);
    EXPECT_EQ(histogram.active[ValueHistogram::kBins / 2], 1);
    EXPECT_EQ(histogram.active[ValueHistogram::kBins - 1], 1);
    EXPECT_EQ(std::accumulate(histogram.active.begin(), histogram.active.end(), 0.0), 2);
}

TEST(ValueHistogram, TakesTilesAloneAndEqualValues) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().addTile(1, Coord(0), 1.0F, true);
    const ValueHistogram histogram = valueHistogram(*grid);
    EXPECT_EQ(histogram.low, 1);
    EXPECT_EQ(histogram.high, 1);
    EXPECT_EQ(histogram.active[0], 512);
    EXPECT_EQ(std::accumulate(histogram.inactive.begin(), histogram.inactive.end(), 0.0), 0);
}

TEST(ValueHistogram, CountsWhatIsNotFiniteAsBackground) {
    auto grid = openvdb::FloatGrid::create(0.25F);
    grid->tree().setValue(Coord(0), std::numeric_limits<float>::quiet_NaN());
    grid->tree().setValue(Coord(1, 0, 0), std::numeric_limits<float>::infinity());
    grid->tree().setValue(Coord(2, 0, 0), 1.0F);
    const ValueHistogram histogram = valueHistogram(*grid);
    EXPECT_EQ(histogram.low, 0.25);
    EXPECT_EQ(histogram.high, 1);
    EXPECT_EQ(histogram.active[0], 2);
}

TEST(ValueHistogram, IsTheSameForAnyNumberOfThreads) {
    const auto grid = summary_grids::mixedGrid();
    const ValueHistogram many = valueHistogram(*grid);
    const ThreadLimit one(1);
    EXPECT_EQ(valueHistogram(*grid).active, many.active);
}

TEST(ValueHistogram, RefusesEmptyGrids) {
    try {
        valueHistogram(*openvdb::FloatGrid::create());
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Result);
    }
}

}  // namespace
}  // namespace bandvox

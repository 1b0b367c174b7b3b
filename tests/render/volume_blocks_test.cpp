#include "render/volume_blocks.h"

#include "render/ball_scene.h"
#include "stop_after.h"

#include <bandvox/reconstruct/brick_reconstruction.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kNothing = 1e-6;

// The bound of the block that a place is in; 0 if nothing is there.
double boundAt(const VolumeBlocks& blocks, const Vec3d& place) {
    double bound = 0;
    // A ray that hardly moves.
    blocks.walk({place, Vec3d(1, 0, 0)}, 1e-9, [&](double, double, double most) {
        bound = most;
        return true;
    });
    return bound;
}

// Compares the bounds to the density at random places. Returns how close it comes.
double compare(const openvdb::FloatGrid::ConstPtr& grid,
               const std::optional<ExponentialFilter>& filter, double low, double high) {
    const VolumeBlocks blocks(*grid, filter, kNothing);
    EXPECT_TRUE(blocks.finite());
    const auto reconstruction =
        filter ? makeBrickReconstruction(grid, {*filter, 1e-4}) : makeAveragingReconstruction(grid);
    const auto probe = reconstruction->probe();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(low, high);
    double closest = 0;
    for (int i = 0; i < 40000; ++i) {
        Vec3d place(uniform(random), uniform(random), uniform(random));
        // Half of them in the middle between nodes.
        if (i % 2)
            place = Vec3d(std::floor(place[0]), std::floor(place[1]), std::floor(place[2])) + 0.5;
        const double density = probe->value(place), bound = boundAt(blocks, place);
        // What was cut off of the band-limited lattice.
        EXPECT_LE(density, bound + (filter ? 3e-4 : 1.1 * kNothing)) << place;
        if (bound > 0.05) closest = std::max(closest, density / bound);
        if (testing::Test::HasFailure()) break;
    }
    return closest;
}

TEST(VolumeBlocks, BoundTheBandLimitedDensity) {
    // Points of any size, filtered: the sharpest densities that the filter leaves.
    const double sigma = 1 / (std::numbers::sqrt2 * std::numbers::pi * ExponentialFilter().cutoff);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const int points : {1, 8, 60}) {
        std::vector<std::pair<Vec3d, double>> all;
        for (int i = 0; i < points; ++i) {
            const Vec3d place(40 * uniform(random), 40 * uniform(random), 40 * uniform(random));
            all.emplace_back(place, uniform(random));
        }
        all[0] = {Vec3d(20.5, 16.5, 15.5), 1};
        const auto grid = render_test::makeGrid({Coord(-8), Coord(48)}, {}, [&](const Vec3d& x) {
            double sum = 0;
            for (const auto& [place, size] : all) {
                sum += 0.5 * size * std::exp(-0.5 * (x - place).lengthSqr() / (sigma * sigma));
            }
            return sum;
        });
        const double closest = compare(grid, ExponentialFilter(), -6, 46);
        EXPECT_GT(closest, 0.9);  // nor are they far above
    }
    compare(render_test::ballGrid(), ExponentialFilter(), -10, 40);
}

TEST(VolumeBlocks, BoundAveragesOfRandomValues) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const double filled : {1.0, 0.5, 0.02}) {
        for (const bool binary : {false, true}) {
            auto grid = openvdb::FloatGrid::create(0);
            auto accessor = grid->getAccessor();
            const openvdb::CoordBBox box(Coord(-3), Coord(40));
            for (auto voxel = box.begin(); voxel; ++voxel) {
                if (uniform(random) > filled) continue;
                accessor.setValue(*voxel, binary ? 1.0F : static_cast<float>(uniform(random)));
            }
            compare(grid, std::nullopt, -6, 44);
        }
    }
}

TEST(VolumeBlocks, KeepWhatStopsLightBesideWhatStopsMore) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->denseFill({Coord(0), Coord(15)}, 1.0F, true);
    grid->tree().setValue(Coord(40), 1e7F);
    EXPECT_GE(boundAt(VolumeBlocks(*grid, std::nullopt, 0.5), Vec3d(4)), 1);
    EXPECT_EQ(boundAt(VolumeBlocks(*grid, std::nullopt, 2), Vec3d(4)), 0);
    // Nor is anything left out beside the highest alone.
    grid->tree().setValue(Coord(40), 1e3F);
    EXPECT_GE(boundAt(VolumeBlocks(*grid, std::nullopt, 2), Vec3d(4)), 1);
}

TEST(VolumeBlocks, BoundWhatIsBetweenTiles) {
    for (const bool reversed : {false, true}) {
        auto grid = openvdb::FloatGrid::create(0);
        grid->tree().addTile(1, Coord(reversed ? 8 : 0, 0, 0), 1.0F, true);
        grid->tree().addTile(1, Coord(reversed ? 0 : 8, 0, 0), 0.1F, true);
        grid->tree().addTile(2, Coord(128, 0, 0), 0.2F, true);
        compare(grid, std::nullopt, -4, 20);
        compare(grid, std::nullopt, 100, 140);
    }
}

// Around tiles of 4096³ voxels no leaves are made: a ray along one of their faces finds whole
// nodes.
TEST(VolumeBlocks, TakeNoLeavesAroundTheLargestTiles) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(3, Coord(0), 1.0F, true);
    grid->tree().addTile(3, Coord(4096, 0, 0), 0.5F, true);
    const VolumeBlocks blocks(*grid, std::nullopt, kNothing);
    for (const Vec3d& start : {Vec3d(-200, 50, -2), Vec3d(-200, 4097, 1000)}) {
        double length = 0;
        int visits = 0;
        blocks.walk({start, Vec3d(1, 0, 0)}, 1e30, [&](double t0, double t1, double most) {
            ++visits;
            length += t1 - t0;
            // The higher tile reaches a little into what is beside the lower one.
            const double x = start[0] + 0.5 * (t0 + t1);
            EXPECT_NEAR(most, x < 4096 + 64 ? 1 : 0.5, 1e-3) << x;
            return false;
        });
        EXPECT_NEAR(length, 2 * 4096 + 2 * 64, 1e-6);
        EXPECT_EQ(visits, 2 * 64 + 2);
    }
    EXPECT_EQ(boundAt(blocks, Vec3d(1000, 1000, -100)), 0);
    EXPECT_GE(boundAt(blocks, Vec3d(4095 + 3, 1000, 1000)), 1) << "what is beside a higher one";
    EXPECT_NEAR(boundAt(blocks, Vec3d(4096 + 100, 1000, 1000)), 0.5, 1e-3);
}

TEST(VolumeBlocks, AskWhetherToStop) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(3, Coord(0), 1.0F, true);
    expectStopsMidway(
        200, [&](Progress& progress) { VolumeBlocks(*grid, std::nullopt, kNothing, progress); });
}

TEST(VolumeBlocks, LeaveOutWhatIsEmpty) {
    EXPECT_TRUE(VolumeBlocks(*openvdb::FloatGrid::create(0), std::nullopt, kNothing).empty());
    const VolumeBlocks blocks(*render_test::ballGrid(), ExponentialFilter(), kNothing);
    EXPECT_FALSE(blocks.empty());
    EXPECT_EQ(boundAt(blocks, render_test::kCenter + Vec3d(40, 0, 0)), 0);
    auto broken = openvdb::FloatGrid::create(0);
    broken->tree().setValue(Coord(0), std::nanf(""));
    EXPECT_FALSE(VolumeBlocks(*broken, std::nullopt, kNothing).finite());
    auto huge = openvdb::FloatGrid::create(0);
    huge->tree().addTile(1, Coord(0), 1e35F, true);
    EXPECT_FALSE(VolumeBlocks(*huge, std::nullopt, kNothing).finite());
}

}  // namespace
}  // namespace bandvox

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/balls_to_solid_grid.h>
#include <bandvox/mesh/grid_surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

double volumeOf(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

double volumeOf(const openvdb::FloatGrid::Ptr& grid) {
    return makeGridSurface("balls", grid)->volume();
}

TEST(BallsToSolidGrid, ABallHasItsVolumeAndPlace) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
    // In voxels of the density; the first are drawn on finer lattices, the last as shells.
    for (const auto& [radius, error] :
         {std::pair(0.2, 0.02), std::pair(0.4, 0.02), std::pair(0.8, 0.02), std::pair(1.6, 2e-3),
          std::pair(8.0, 1e-4), std::pair(40.0, 2e-5)}) {
        for (int i = 0; i < 5; ++i) {
            // Two of them, so that they lie anywhere on the lattice that begins between.
            const Vec3d first(1000 + anywhere(random), anywhere(random), -70 + anywhere(random));
            const Vec3d apart(4 * radius + anywhere(random), anywhere(random), anywhere(random));
            const std::vector<Vec3d> centers{first, first + apart};
            const std::vector<double> radii{radius, radius};
            const BallGrid drawn = ballsToSolidGrid({centers, radii}, 1);
            EXPECT_EQ(drawn.tooSmall, 0U);
            const auto surface = makeGridSurface("balls", drawn.grid);
            EXPECT_NEAR(surface->volume() / (2 * volumeOf(radius)), 1, error) << radius;
            const openvdb::BBoxd box = surface->bounds();
            EXPECT_NEAR((box.getCenter() - first - 0.5 * apart).length(), 0, 0.05);
            EXPECT_NEAR(box.extents()[0], 2 * radius + apart[0], 0.15);
        }
    }
}

TEST(BallsToSolidGrid, TwoBallsOverlapAsTheClosedFormSays) {
    const double a = 1, b = 0.7;
    const std::vector<double> radii{a, b};
    // Beside each other, touching, cutting, and one in the other.
    for (const double d : {1.9, 1.7, 1.2, 0.5, 0.2}) {
        const std::vector<Vec3d> centers{{0.01, 0.02, 3}, {0.01 + 0.6 * d, 0.02, 3 + 0.8 * d}};
        double common = 0;
        if (d <= a - b) {
            common = volumeOf(b);
        } else if (d < a + b) {
            common = std::numbers::pi * std::pow(a + b - d, 2) *
                     (d * d + 2 * d * b - 3 * b * b + 2 * d * a + 6 * a * b - 3 * a * a) / (12 * d);
        }
        const double both = volumeOf(a) + volumeOf(b) - common;
        // Drawn as balls and as shells.
        for (const double voxel : {0.08, 0.04, 0.02}) {
            const double volume = volumeOf(ballsToSolidGrid({centers, radii}, voxel).grid);
            EXPECT_NEAR(volume / both, 1, 0.2 * voxel * voxel) << d << " " << voxel;
        }
    }
}

TEST(BallsToSolidGrid, ManyAreTheSameForAnyNumberOfThreads) {
    constexpr int kSide = 46;  // of a lattice of balls that do not touch: nearly 100000
    std::vector<Vec3d> centers;
    std::vector<double> radii;
    double sum = 0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.2, 0.45);
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        centers.emplace_back(i % kSide, i / kSide % kSide, i / kSide / kSide);
        radii.push_back(share(random));
        sum += volumeOf(radii.back());
    }
    std::vector<double> volumes;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        const BallGrid drawn = ballsToSolidGrid({centers, radii}, 0.25);
        volumes.push_back(volumeOf(drawn.grid));
    }
    EXPECT_NEAR(volumes[0] / sum, 1, 1e-2);
    EXPECT_EQ(volumes[1], volumes[0]);
    EXPECT_EQ(volumes[2], volumes[0]);
}

TEST(BallsToSolidGrid, ManyLargeOnesAreTheirUnion) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> anywhere(-6, 6), radius(0.9, 2);
    std::vector<Vec3d> centers;
    std::vector<double> radii;
    for (int i = 0; i < 37; ++i) {
        centers.emplace_back(anywhere(random), anywhere(random), anywhere(random));
        radii.push_back(radius(random));
    }
    const auto grid = ballsToSolidGrid({centers, radii}, 0.05).grid;
    const double voxel = grid->voxelSize()[0];
    ASSERT_GT(0.9, 32 * voxel) << "they are no shells";
    const auto values = grid->getConstAccessor();
    int near = 0;
    for (int i = 0; i < 200000; ++i) {
        const Vec3d place(anywhere(random), anywhere(random), anywhere(random));
        const auto at = openvdb::Coord::round(grid->worldToIndex(place));
        double distance = 1e9;
        for (std::size_t k = 0; k < radii.size(); ++k) {
            const Vec3d center = centers[k];
            distance = std::min(distance, (grid->indexToWorld(at) - center).length() - radii[k]);
        }
        const double found = values.getValue(at);
        if (std::abs(distance) < 1.5 * voxel) {
            ++near;
            EXPECT_NEAR(found, distance, 0.02 * voxel);
        } else {
            EXPECT_EQ(found < 0, distance < 0);
        }
    }
    EXPECT_GT(near, 500);
}

TEST(BallsToSolidGrid, CountsWhatIsTooSmall) {
    const std::vector<Vec3d> centers{{0, 0, 0}, {5, 0, 0}, {10, 0, 0}};
    const std::vector<double> radii{2, 0, 0.1};
    const BallGrid drawn = ballsToSolidGrid({centers, radii}, 1);
    EXPECT_EQ(drawn.tooSmall, 2U);
    EXPECT_NEAR(drawn.lostVolume, volumeOf(0.1), 1e-12);
    EXPECT_NEAR(volumeOf(drawn.grid) / volumeOf(2.0), 1, 1e-3);
}

TEST(BallsToSolidGrid, RefusesWhatCannotBe) {
    const std::vector<Vec3d> center{{0, 0, 0}}, far{{1e12, 0, 0}};
    const std::vector<double> one{1}, none, tiny{0.01};
    const auto kindOf = [](const auto& call) {
        try {
            call();
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({center, one}, 0); }), ErrorKind::Usage);
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({center, none}, 1); }), ErrorKind::Usage);
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({center, tiny}, 1); }), ErrorKind::Result);
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({far, one}, 1); }), ErrorKind::Input);
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({center, one}, 1e-7); }), ErrorKind::Memory);
    class Stop : public Progress {
      public:
        bool interrupted() const override { return true; }
    } stop;
    EXPECT_EQ(kindOf([&] { ballsToSolidGrid({center, one}, 0.2, stop); }), ErrorKind::Interrupted);
}

}  // namespace
}  // namespace bandvox

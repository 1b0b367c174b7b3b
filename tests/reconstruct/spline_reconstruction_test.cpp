#include <bandvox/core/error.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

openvdb::FloatGrid::Ptr sampled(const openvdb::CoordBBox& box, float background,
                                const std::function<double(const Vec3d&)>& f) {
    auto grid = openvdb::FloatGrid::create(background);
    auto accessor = grid->getAccessor();
    for (auto voxel = box.begin(); voxel; ++voxel) {
        accessor.setValue(*voxel, static_cast<float>(f((*voxel).asVec3d())));
    }
    return grid;
}

TEST(SplineReconstruction, GoesThroughTheLattice) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const openvdb::CoordBBox box(openvdb::Coord(-9, -40, 25), openvdb::Coord(20, -15, 45));
    const auto grid = sampled(box, 0.25F, [&](const Vec3d&) { return uniform(random); });
    const auto spline = makeSplineReconstruction(grid);
    openvdb::CoordBBox wider = box;
    wider.expand(6);
    for (auto voxel = wider.begin(); voxel; ++voxel) {
        ASSERT_NEAR(spline->value((*voxel).asVec3d()), grid->tree().getValue(*voxel), 3e-6)
            << *voxel;
    }
    EXPECT_NEAR(spline->value(Vec3d(1000.3)), 0.25, 1e-6);
}

// A cubic polynomial is its own interpolating spline.
TEST(SplineReconstruction, ReproducesCubics) {
    const auto f = [](const Vec3d& p) {
        const Vec3d q = p / 16.0;
        return 0.3 + q.x() - q.y() * q.z() + 0.5 * q.x() * q.x() * q.y() + q.z() * q.z() * q.z();
    };
    const auto gradient = [](const Vec3d& p) {
        const Vec3d q = p / 16.0;
        return Vec3d(1 + q.x() * q.y(), -q.z() + 0.5 * q.x() * q.x(), -q.y() + 3 * q.z() * q.z()) /
               16.0;
    };
    const auto grid =
        sampled({openvdb::Coord(-40), openvdb::Coord(40)}, 0, [&](const Vec3d& p) { return f(p); });
    const auto spline = makeSplineReconstruction(grid);
    const auto probe = spline->probe();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-20, 20);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d place(uniform(random), uniform(random), uniform(random));
        const DensityAt at = probe->evaluate(place);
        EXPECT_NEAR(at.value, f(place), 3e-5);
        EXPECT_NEAR(probe->value(place), f(place), 3e-5);
        EXPECT_LT((at.gradient - gradient(place)).length(), 3e-5);
    }
}

TEST(SplineReconstruction, IsSmoothAcrossBricks) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto grid = sampled({openvdb::Coord(-8), openvdb::Coord(40)}, 0,
                              [&](const Vec3d&) { return uniform(random); });
    const auto spline = makeSplineReconstruction(grid);
    for (int i = 0; i < 200; ++i) {
        Vec3d place(8 + 10 * uniform(random), 8 + 10 * uniform(random), 32);
        const DensityAt before = spline->evaluate(place - Vec3d(0, 0, 1e-4));
        const DensityAt after = spline->evaluate(place + Vec3d(0, 0, 1e-4));
        EXPECT_NEAR(before.value, after.value, 2e-3);
        EXPECT_LT((before.gradient - after.gradient).length(), 5e-3);
    }
}

double cubicSpline(double x) {
    const double d = std::abs(x);
    if (d < 1) return 2.0 / 3 - d * d + 0.5 * d * d * d;
    return d < 2 ? std::pow(2 - d, 3) / 6 : 0;
}

TEST(AveragingReconstruction, WeighsTheNodesAroundAPlace) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto grid = sampled({openvdb::Coord(-8), openvdb::Coord(40)}, 0,
                              [&](const Vec3d&) { return uniform(random) < 0.5 ? 0 : 1; });
    const auto average = makeAveragingReconstruction(grid);
    for (int i = 0; i < 500; ++i) {
        const Vec3d place(16 + 60 * (uniform(random) - 0.5), 16 + 60 * (uniform(random) - 0.5),
                          16 + 60 * (uniform(random) - 0.5));
        double sum = 0;
        openvdb::CoordBBox nodes(openvdb::Coord::floor(place - Vec3d(1.0)),
                                 openvdb::Coord::floor(place + Vec3d(2.0)));
        for (auto node = nodes.begin(); node; ++node) {
            const Vec3d away = (*node).asVec3d() - place;
            sum += cubicSpline(away[0]) * cubicSpline(away[1]) * cubicSpline(away[2]) *
                   grid->tree().getValue(*node);
        }
        EXPECT_NEAR(average->value(place), sum, 1e-5) << place;
    }
}

TEST(AveragingReconstruction, IsNothingWhereNothingIsAround) {
    const auto grid =
        sampled({openvdb::Coord(0), openvdb::Coord(15)}, 0, [](const Vec3d&) { return 1; });
    const auto average = makeAveragingReconstruction(grid);
    for (double x = 17; x < 24; x += 0.25) {
        EXPECT_NEAR(average->value(Vec3d(x, 7.3, 8.1)), 0, 1e-8) << x;
    }
    EXPECT_NEAR(average->value(Vec3d(7.5, 7.3, 8.1)), 1, 1e-6);
}

// Bricks in the middle of large tiles are not copied; that changes nothing.
TEST(SplineReconstruction, ReadsLargeTilesAsIfTheyWereVoxels) {
    auto tiles = openvdb::FloatGrid::create(0.5F);
    tiles->tree().addTile(2, openvdb::Coord(0), 1.0F, true);
    tiles->tree().addTile(2, openvdb::Coord(128, 0, 0), 1.0F, true);
    tiles->tree().addTile(2, openvdb::Coord(0, 128, 0), 3.0F, true);
    const auto voxels = tiles->deepCopy();
    voxels->tree().voxelizeActiveTiles();
    const auto read = makeSplineReconstruction(tiles), expected = makeSplineReconstruction(voxels);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-40, 296);
    for (int i = 0; i < 300; ++i) {
        const Vec3d place(uniform(random), uniform(random), 0.4 * uniform(random));
        ASSERT_EQ(read->value(place), expected->value(place)) << place;
    }
    EXPECT_EQ(read->value(Vec3d(126.5, 64.3, 64.2)), 1);
}

TEST(SplineReconstruction, NeedsAGrid) {
    EXPECT_THROW(makeSplineReconstruction(nullptr), Error);
    EXPECT_THROW(makeAveragingReconstruction(nullptr), Error);
}

}  // namespace
}  // namespace bandvox

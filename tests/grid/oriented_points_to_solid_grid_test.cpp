#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/oriented_points_to_solid_grid.h>
#include <bandvox/mesh/grid_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

struct Samples {
    std::vector<Vec3d> points;
    std::vector<openvdb::Vec3f> normals;
    operator OrientedPoints() const { return {points, normals}; }

    void add(const Vec3d& point, const Vec3d& normal) {
        points.push_back(point);
        normals.emplace_back(normal);
    }
};

/// Evenly over a ball, each point moved by `noise` in each direction, standard deviation.
Samples ball(int count, double noise, const Vec3d& center = Vec3d(0), double radius = 1) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    Samples samples;
    for (int i = 0; i < count; ++i) {
        Vec3d n(normal(random), normal(random), normal(random));
        n.normalize();
        samples.add(
            center + radius * n + noise * Vec3d(normal(random), normal(random), normal(random)),
            2.5 * n);
    }
    return samples;
}

Samples torus(int count, double noise) {
    constexpr double kMiddle = 0.7, kTube = 0.3;
    std::mt19937 random(6);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi), share(0, 1);
    Samples samples;
    while (std::ssize(samples.points) < count) {
        const double a = turn(random), b = turn(random);
        if (share(random) * (kMiddle + kTube) > kMiddle + kTube * std::cos(b)) continue;
        const Vec3d along(std::cos(a), std::sin(a), 0);
        const Vec3d n = std::cos(b) * along + Vec3d(0, 0, std::sin(b));
        samples.add(kMiddle * along + kTube * n +
                        noise * Vec3d(normal(random), normal(random), normal(random)),
                    n);
    }
    return samples;
}

double volumeOf(const OrientedPointsGrid& made) {
    return makeGridSurface("points", made.grid)->volume();
}

constexpr double kBall = 4.0 / 3.0 * std::numbers::pi;

TEST(OrientedPointsToSolidGrid, ABallAndATorusHaveTheirVolumes) {
    const double torusVolume = 2 * std::numbers::pi * std::numbers::pi * 0.7 * 0.3 * 0.3;
    for (const double voxel : {0.05, 0.012}) {
        const OrientedPointsGrid made = orientedPointsToSolidGrid(ball(5000, 0), voxel);
        EXPECT_NEAR(volumeOf(made) / kBall, 1, 3e-3);
        EXPECT_TRUE(made.warnings.empty()) << made.warnings.front();
        EXPECT_NEAR(made.spacing, 1.2 * std::sqrt(4 * std::numbers::pi / 5000), 0.03);
        EXPECT_LE(made.grid->voxelSize()[0], voxel / 2 + 1e-12);
    }
    EXPECT_NEAR(volumeOf(orientedPointsToSolidGrid(ball(5000, 0.01), 0.05)) / kBall, 1, 5e-3);
    EXPECT_NEAR(volumeOf(orientedPointsToSolidGrid(torus(5000, 0), 0.05)) / torusVolume, 1, 5e-3);
    EXPECT_NEAR(volumeOf(orientedPointsToSolidGrid(torus(5000, 0.01), 0.05)) / torusVolume, 1,
                1e-2);
}

TEST(OrientedPointsToSolidGrid, ItsSurfaceIsNearThePoints) {
    const Samples samples = ball(3000, 0, Vec3d(100, -3, 7), 0.5);
    const OrientedPointsGrid made = orientedPointsToSolidGrid(samples, 0.02);
    const auto accessor = made.grid->getConstAccessor();
    int checked = 0;
    for (auto value = made.grid->cbeginValueOn(); value; ++value) {
        const double distance =
            (made.grid->indexToWorld(value.getCoord()) - Vec3d(100, -3, 7)).length() - 0.5;
        if (std::abs(distance) < 0.5 * made.spacing) continue;
        ASSERT_EQ(*value < 0, distance < 0) << distance;
        ++checked;
    }
    EXPECT_GT(checked, 10000);
    EXPECT_LT(accessor.getValue(openvdb::Coord::round(made.grid->worldToIndex({100, -3, 7}))), 0);
}

TEST(OrientedPointsToSolidGrid, FindsEveryPart) {
    Samples both = ball(3000, 0);
    const Samples other = ball(800, 0, {3, 0, 0}, 0.5);
    both.points.insert(both.points.end(), other.points.begin(), other.points.end());
    both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
    EXPECT_NEAR(volumeOf(orientedPointsToSolidGrid(both, 0.05)) / (kBall * 1.125), 1, 0.02);
}

TEST(OrientedPointsToSolidGrid, TurnsNormalsThatPointInward) {
    Samples samples = ball(2000, 0);
    for (auto& normal : samples.normals) normal = -normal;
    const OrientedPointsGrid made = orientedPointsToSolidGrid(samples, 0.1);
    EXPECT_TRUE(made.turned);
    ASSERT_EQ(made.warnings.size(), 1U);
    EXPECT_NE(made.warnings[0].find("inward"), std::string::npos);
    EXPECT_NEAR(volumeOf(made) / kBall, 1, 0.01);
}

TEST(OrientedPointsToSolidGrid, SaysWhatIsAGuess) {
    // A ball without its upper third, and points that know nothing.
    Samples samples;
    const Samples whole = ball(6000, 0);
    for (std::size_t i = 0; i < whole.points.size(); ++i) {
        if (whole.points[i].z() < 0.3) samples.add(whole.points[i], Vec3d(whole.normals[i]));
    }
    samples.add({0.5, 0, 0}, {0, 0, 0});
    const OrientedPointsGrid made = orientedPointsToSolidGrid(samples, 0.05);
    EXPECT_EQ(made.withoutNormal, 1U);
    EXPECT_GT(made.unsupported, 0.05);
    ASSERT_GE(made.warnings.size(), 2U);
    EXPECT_NE(made.warnings[0].find("1 point of"), std::string::npos) << made.warnings[0];
    EXPECT_NE(made.warnings[1].find("guess"), std::string::npos) << made.warnings[1];
    EXPECT_GT(volumeOf(made), 0.6 * kBall);
}

TEST(OrientedPointsToSolidGrid, IsTheSameForAnyNumberOfThreads) {
    const Samples samples = torus(2000, 0.01);
    std::vector<double> volumes;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        volumes.push_back(volumeOf(orientedPointsToSolidGrid(samples, 0.05)));
    }
    EXPECT_EQ(volumes[1], volumes[0]);
    EXPECT_EQ(volumes[2], volumes[0]);
}

TEST(OrientedPointsToSolidGrid, TakesAPlaceOnceHoweverOftenItIsThere) {
    const Samples once = ball(500, 0);
    Samples often = once;
    for (int i = 0; i < 50000; ++i) often.add(once.points[7], once.normals[7]);
    const double expected = volumeOf(orientedPointsToSolidGrid(once, 0.1));
    EXPECT_NEAR(volumeOf(orientedPointsToSolidGrid(often, 0.1)), expected, 0.1 * expected);
}

TEST(OrientedPointsToSolidGrid, RefusesWhatIsNoSurface) {
    const auto kindOf = [](const Samples& samples, double voxel = 0.1,
                           Progress& progress = silentProgress()) {
        try {
            orientedPointsToSolidGrid(samples, voxel, progress);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    EXPECT_EQ(kindOf(ball(9, 0)), ErrorKind::Input);
    EXPECT_EQ(kindOf(ball(100, 0), 0), ErrorKind::Usage);
    Samples fewer = ball(100, 0);
    fewer.normals.pop_back();
    EXPECT_EQ(kindOf(fewer), ErrorKind::Usage);
    Samples flat = ball(100, 0);
    for (Vec3d& point : flat.points) point.z() = 0;
    EXPECT_EQ(kindOf(flat), ErrorKind::Input);
    Samples same = ball(100, 0);
    for (Vec3d& point : same.points) point = Vec3d(1, 2, 3);
    EXPECT_EQ(kindOf(same), ErrorKind::Input);
    class Stop : public Progress {
      public:
        bool interrupted() const override { return true; }
    } stop;
    EXPECT_EQ(kindOf(ball(2000, 0), 0.1, stop), ErrorKind::Interrupted);
}

}  // namespace
}  // namespace bandvox

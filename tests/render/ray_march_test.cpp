#include "render/ray_march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace {

using bandvox::ClearDistance;
using bandvox::DensityAt;
using bandvox::Ray;
using bandvox::RayMarch;
using bandvox::SurfaceBlocks;
using openvdb::Coord;
using openvdb::Vec3d;

// A density given by a function, which also counts how often it is asked.
class FunctionProbe final : public bandvox::DensityProbe {
  public:
    explicit FunctionProbe(std::function<double(const Vec3d&)> f) : mFunction(std::move(f)) {}

    double value(const Vec3d& x) override {
        ++asked;
        return mFunction(x);
    }
    DensityAt evaluate(const Vec3d& x) override {
        DensityAt at{value(x), Vec3d(0.0)};
        constexpr double kStep = 1e-6;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step(0.0);
            step[axis] = kStep;
            at.gradient[axis] = (mFunction(x + step) - mFunction(x - step)) / (2 * kStep);
        }
        return at;
    }
    bandvox::DensityExpansion expand(const Vec3d& x) override {
        const DensityAt at = evaluate(x);
        return {at.value, at.gradient, openvdb::Mat3d::zero()};
    }

    int asked = 0;

  private:
    std::function<double(const Vec3d&)> mFunction;
};

// Blocks all over [0, 128)³.
SurfaceBlocks everywhere() {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(2, Coord(0), 1.0F, true);
    return SurfaceBlocks(*grid, 0.5);
}

constexpr double kCutoff = 0.16;

double face(double r) {
    return 0.5 * std::erfc(std::numbers::pi * kCutoff * r);
}

TEST(ClearDistance, OfAGaussianIsThatOfAHalfSpaceOrLess) {
    for (const double iso : {0.1, 0.5, 0.9}) {
        const ClearDistance clear = ClearDistance::ofGaussian(iso, kCutoff);
        double surface = -10;
        while (face(surface) > iso) surface += 1e-4;
        for (double r = surface; r < 12; r += 0.01) {
            const double distance = clear(face(r) - iso);
            EXPECT_LE(distance, r - surface + 1e-3) << iso;
            // Not much less, unless the density is hardly anything.
            if (face(r) > 0.05) {
                EXPECT_GE(distance, r - surface - 0.2) << iso;
            }
        }
    }
}

TEST(ClearDistance, OfASlopeIsProportional) {
    const ClearDistance clear = ClearDistance::ofSlope(0.6, 0.1, 0.25);
    for (double density = 0.1; density < 0.6; density += 0.003) {
        const double distance = (0.6 - density) / 0.25;
        EXPECT_LE(clear(density - 0.6), distance + 1e-6);
        EXPECT_GE(clear(density - 0.6), distance - 0.02);
    }
    EXPECT_NEAR(clear(-0.5), clear(-0.7), 0.01) << "below the background";
}

TEST(RayMarch, FindsAFaceInAFewSteps) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofGaussian(0.5, kCutoff));
    for (const double speed : {1.0, 0.01, 300.0}) {
        FunctionProbe probe([](const Vec3d& x) { return face(61.234 - x[0]); });
        const auto hit = march.firstHit({Vec3d(-30, 40, 40), Vec3d(speed, 0.1 * speed, 0)}, probe);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t * speed, 91.234, 1e-5);
        const double slope = kCutoff * std::sqrt(std::numbers::pi);
        EXPECT_NEAR((hit->gradient - Vec3d(slope, 0, 0)).length(), 0, 1e-6);
        EXPECT_LT(probe.asked, 50);
    }
}

TEST(RayMarch, FindsTheFirstOfSeveralCrossings) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofSlope(0.5, 0, 1));
    FunctionProbe probe([](const Vec3d& x) { return 0.5 - 0.4 * std::cos(0.3 * (x[2] - 7)); });
    const auto hit = march.firstHit({Vec3d(5, 5, 7), Vec3d(0, 0, 1)}, probe);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, std::numbers::pi / 0.6, 1e-5);
}

TEST(RayMarch, FindsATopBetweenItsSteps) {
    // A bump that is above iso for a fiftieth of a voxel.
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofSlope(0.5, 0, 0.3));
    const double half = 0.01;
    for (double place = 50; place < 50.5; place += 0.0173) {
        FunctionProbe probe([&](const Vec3d& x) {
            const double r = (x[0] - place) / 4;
            return 0.5 * std::exp(-r * r) / std::exp(-half * half / 16);
        });
        const auto hit = march.firstHit({Vec3d(3, 5, 5), Vec3d(1, 0, 0)}, probe);
        ASSERT_TRUE(hit) << place;
        EXPECT_NEAR(hit->t + 3, place - half, 1e-4);
    }
}

TEST(RayMarch, HitsAtItsOriginInside) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofGaussian(0.5, kCutoff));
    FunctionProbe probe([](const Vec3d& x) { return face(40 - x[0]); });
    const auto hit = march.firstHit({Vec3d(64, 5, 5), Vec3d(-1, 0, 0)}, probe);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0);
}

TEST(RayMarch, SeesFromFarAway) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofGaussian(0.5, kCutoff));
    for (const double distance : {1e6, 1e9, 1e11, 1e15, 1e30}) {
        Vec3d nearest(0.0);
        FunctionProbe probe([&](const Vec3d& x) {
            nearest = x;
            return face(61.234 - x[0]);
        });
        const auto hit = march.firstHit({Vec3d(-distance, 40, 40), Vec3d(1, 0, 0)}, probe);
        ASSERT_TRUE(hit || distance > 1e15) << distance;
        EXPECT_LT(probe.asked, 100) << distance;
        // What is rounded is how far it is, not where.
        if (hit) {
            EXPECT_NEAR(nearest[0], 61.234, 1e-4) << distance;
        }
        if (hit) {
            EXPECT_NEAR(hit->t, distance + 61.234, 1e-15 * distance + 1e-5);
        }
    }
}

TEST(RayMarch, EndsWhateverTheDensity) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofSlope(0.5, 0, 1));
    FunctionProbe jump([](const Vec3d& x) { return x[0] < 61.234 ? -1e300 : 1e300; });
    const auto hit = march.firstHit({Vec3d(-30, 40, 40), Vec3d(1, 0, 0)}, jump);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 91.234, 1e-4);
    EXPECT_LT(jump.asked, 1000);
}

TEST(RayMarch, MissesWhatStaysBelow) {
    const SurfaceBlocks blocks = everywhere();
    const RayMarch march(blocks, 0.5, ClearDistance::ofGaussian(0.5, kCutoff));
    FunctionProbe probe([](const Vec3d& x) { return 0.499 * std::exp(-x[0] * x[0] / 500); });
    EXPECT_FALSE(march.firstHit({Vec3d(-30, 40, 40), Vec3d(1, 0, 0)}, probe));
    EXPECT_FALSE(march.firstHit({Vec3d(-30, 40, 40), Vec3d(-1, 0, 0)}, probe));
}

}  // namespace

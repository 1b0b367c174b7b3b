#include "render/medium_scene.h"

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Vec3d;

// Transforms of the lattice: as it is, of other voxels than cubes, turned, sheared.
std::vector<openvdb::math::Transform::Ptr> transforms() {
    std::vector<openvdb::math::Transform::Ptr> all;
    all.push_back(openvdb::math::Transform::createLinearTransform(1.0));
    all.push_back(openvdb::math::Transform::createLinearTransform(0.3));
    all.back()->postTranslate(Vec3d(5, -7, 2));
    all.push_back(openvdb::math::Transform::createLinearTransform(1.0));
    all.back()->postScale(Vec3d(0.5, 1, 2));
    all.back()->postRotate(0.7, openvdb::math::X_AXIS);
    all.back()->postRotate(-0.3, openvdb::math::Z_AXIS);
    all.push_back(openvdb::math::Transform::createLinearTransform(0.8));
    all.back()->postShear(0.4, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
    all.back()->postTranslate(Vec3d(-1, 2, 30));
    return all;
}

Scene sceneOf(const std::vector<SceneObject>& objects) {
    Scene scene;
    scene.objects = objects;
    return scene;
}

// Errors of what is left, for extinctions at which there is something left.
struct Worst {
    double error = 0;
    void see(double found, double expected) { error = std::max(error, std::abs(found - expected)); }
};

TEST(Transmittance, OfGaussianBlobsIsThatOfTheirIntegral) {
    Worst worst;
    for (const double sigma : {1.5, 3.0, 6.0}) {
        for (const auto& transform : transforms()) {
            const auto grid = blobGrid(sigma);
            grid->setTransform(transform);
            const Vec3d middle = grid->indexToWorld(kBlobMiddle);
            const double size = sigma * grid->voxelSize()[1];
            for (const double depth : {0.1, 1.0, 2.5}) {
                const double extinction = depth / (2.5 * size);
                MediumScene scene(sceneOf({volumeOf(grid, extinction)}), {});
                for (const Ray& ray : raysPast(middle, 2 * size, 20)) {
                    const double expected = std::exp(-extinction * throughBlob(*grid, sigma, ray));
                    const double found = scene.left(ray);
                    worst.see(found, expected);
                    EXPECT_NEAR(found, expected, 1e-4) << sigma << " " << depth;
                    EXPECT_NEAR(scene.along(ray).left, expected, 1e-4);
                }
            }
        }
    }
    RecordProperty("worst", std::to_string(worst.error));
}

// ∫ of the filtered ball's density along a whole line that passes it at a distance.
double throughBall(double beside) {
    double sum = 0;
    constexpr double kStep = 0.02;
    for (double s = 0.5 * kStep; s < 40; s += kStep) {
        sum += 2 * kStep * ballDensity(std::hypot(s, beside), kRadius);
    }
    return sum;
}

TEST(Transmittance, OfAFilteredBallIsThatOfItsIntegral) {
    Worst worst;
    for (const double extinction : {0.003, 0.03, 0.1}) {
        MediumScene scene(sceneOf({volumeOf(ballGrid(), extinction)}), {});
        for (const Ray& ray : raysPast(kCenter, 20, 40)) {
            const double beside = (kCenter - ray.origin).cross(ray.direction).length();
            const double expected = std::exp(-extinction * throughBall(beside));
            worst.see(scene.left(ray), expected);
            EXPECT_NEAR(scene.left(ray), expected, 1e-4) << extinction << " " << beside;
        }
    }
    RecordProperty("worst", std::to_string(worst.error));
}

TEST(Transmittance, OfAFilteredSlabIsThatOfItsIntegral) {
    Worst worst;
    const auto slab = boxGrid(openvdb::BBoxd(Vec3d(-60, -60, -5.3), Vec3d(60, 60, 8.1)));
    for (const double extinction : {0.01, 0.1}) {
        MediumScene scene(sceneOf({volumeOf(slab, extinction)}), {});
        for (const Vec3d& direction : {Vec3d(0, 0, -1), Vec3d(0.3, 0.2, -1), Vec3d(-1, 0.4, 0.8)}) {
            const Vec3d d = direction.unit();
            const double expected = std::exp(-extinction * 13.4 / std::abs(d[2]));
            worst.see(scene.left({-100 * d, d}), expected);
            EXPECT_NEAR(scene.left({-100 * d, d}), expected, 1e-4) << direction;
        }
    }
    RecordProperty("worst", std::to_string(worst.error));
}

// Active tiles, which nobody has band-limited: averages of them have the same integral.
TEST(Transmittance, OfTilesIsThatOfWhatTheyHold) {
    for (const int level : {1, 2}) {
        const int side = level == 1 ? 8 : 128;
        auto grid = openvdb::FloatGrid::create(0);
        for (int x = 0; x < 3; ++x) {
            for (int y = 0; y < 3; ++y) {
                grid->tree().addTile(level, {x * side, y * side, 0}, 0.6F, true);
            }
        }
        for (const Vec3d& direction : {Vec3d(0, 0, -1), Vec3d(0, 0, 1), Vec3d(0.2, 0.1, -1)}) {
            const Vec3d d = direction.unit(), middle(1.5 * side, 1.5 * side, 0.5 * side);
            const Ray ray{middle - 300 * d, d};
            for (const double depth : {0.2, 1.5}) {
                const double extinction = depth / (0.6 * side);
                MediumScene scene(sceneOf({volumeOf(grid, extinction)}), {});
                EXPECT_NEAR(scene.left(ray), std::exp(-depth / std::abs(d[2])), 1e-5)
                    << side << " " << direction;
            }
        }
    }
}

TEST(Transmittance, OfSeveralVolumesMultiplies) {
    const auto first = blobGrid(4), second = blobGrid(2);
    second->transform().postScale(1.7);
    second->transform().postTranslate(Vec3d(4, 1, -2));
    MediumScene scene(sceneOf({volumeOf(first, 0.1), volumeOf(second, 0.2)}), {});
    int both = 0;
    for (const Ray& ray : raysPast(kBlobMiddle, 8, 60)) {
        const double one = std::exp(-0.1 * throughBlob(*first, 4, ray));
        const double other = std::exp(-0.2 * throughBlob(*second, 2, ray));
        if (one < 0.9 && other < 0.9) ++both;
        EXPECT_NEAR(scene.left(ray), one * other, 1e-4);
        EXPECT_NEAR(scene.along(ray).left, one * other, 1e-4);
    }
    EXPECT_GT(both, 10);
}

TEST(Transmittance, EndsWhereTheRayEnds) {
    MediumScene scene(sceneOf({volumeOf(ballGrid(), 0.05)}), {});
    // From the middle on, where the density is 1.
    for (const double end : {0.5, 3.0, 10.0}) {
        const Ray ray{kCenter, Vec3d(1, 0, 0)};
        EXPECT_NEAR(scene.left(ray, 0, end), std::exp(-0.05 * end), 1e-4);
        EXPECT_NEAR(scene.along(ray, 0, end).left, std::exp(-0.05 * end), 1e-4);
    }
    EXPECT_EQ(scene.left({kCenter + Vec3d(100, 0, 0), Vec3d(1, 0, 0)}), 1);
}

TEST(Transmittance, OfShorterStepsIsTheSame) {
    PictureOptions options;
    std::vector<double> expected;
    for (const double step : {1.0, 0.5, 0.11}) {
        options.volumes.step = step;
        MediumScene scene(sceneOf({volumeOf(blobGrid(2), 0.3)}), options);
        const auto rays = raysPast(kBlobMiddle, 4, 20);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double found = scene.left(rays[i]);
            if (step == 1) expected.push_back(found);
            EXPECT_NEAR(found, expected[i], 1e-4);
        }
    }
}

TEST(Transmittance, IsWhatThePictureLetsThrough) {
    Scene scene = sceneOf({volumeOf(blobGrid(5), 0.1)});
    scene.environment.color = Vec3d(0.0);
    const Image image = sceneToImage(scene, pictureFrom({0.2, 0.1, 1}, kBlobMiddle, 15, 30)).image;
    const Vec3d forward = -Vec3d(0.2, 0.1, 1).unit();
    const Vec3d middle = kBlobMiddle - 100 * forward;
    const double expected =
        std::exp(-0.1 * throughBlob(*scene.objects[0].grid, 5, {middle, forward}));
    EXPECT_NEAR(1 - image.color[4 * (7 * 15 + 7) + 3], expected, 1e-4);
    EXPECT_NEAR(image.depth[7 * 15 + 7], 100, 3);
}

// Random ways are right on average.
void compareTracking(const openvdb::FloatGrid::ConstPtr& grid, double extinction, const Ray& ray,
                     double expected) {
    PictureOptions options;
    options.volumes.method = VolumeOptions::Method::Tracking;
    MediumScene scene(sceneOf({volumeOf(grid, extinction)}), options);
    constexpr int kWays = 4000;
    double ratio = 0, squares = 0, passed = 0;
    for (int i = 0; i < kWays; ++i) {
        const double left = scene.left(ray, i);
        ratio += left / kWays;
        squares += left * left / kWays;
        passed += scene.along(ray, i).left / kWays;
    }
    const double error = std::sqrt(std::max(squares - ratio * ratio, 0.0) / kWays);
    EXPECT_NEAR(ratio, expected, 4 * error + 2e-4);
    EXPECT_NEAR(passed, expected, 4 * std::sqrt(expected * (1 - expected) / kWays) + 2e-4);
}

TEST(Tracking, IsRightOnAverage) {
    for (const double extinction : {0.1, 0.5}) {
        const auto blob = blobGrid(3);
        blob->transform().postScale(Vec3d(0.7, 1, 1.2));
        const Vec3d middle = blob->indexToWorld(kBlobMiddle);
        for (const Ray& ray : raysPast(middle, 4, 4)) {
            const double expected = std::exp(-extinction * throughBlob(*blob, 3, ray));
            compareTracking(blob, extinction, ray, expected);
        }
    }
    const auto ball = ballGrid();
    const Ray past{kCenter + Vec3d(5, 0, 60), Vec3d(0, 0, -1)};
    compareTracking(ball, 0.04, past, std::exp(-0.04 * throughBall(5)));
}

// The densest place of a point lies between the nodes: bounds by the nodes alone are too low.
TEST(Tracking, IsRightBetweenTheNodes) {
    const double sigma = 1 / (std::numbers::sqrt2 * std::numbers::pi * ExponentialFilter().cutoff);
    auto grid = openvdb::FloatGrid::create(0);
    const Vec3d middle(2.5, 3.5, 3.5);
    grid = makeGrid({openvdb::Coord(-6), openvdb::Coord(13)}, {}, [&](const Vec3d& x) {
        return std::exp(-0.5 * (x - middle).lengthSqr() / (sigma * sigma));
    });
    const double through = std::sqrt(2 * std::numbers::pi) * sigma;
    compareTracking(grid, 0.4, {middle + Vec3d(0, 0, 50), Vec3d(0, 0, -1)},
                    std::exp(-0.4 * through));
}

TEST(Tracking, EndsHoweverThickAVolumeIs) {
    const auto blob = blobGrid(3);
    PictureOptions options;
    options.volumes.method = VolumeOptions::Method::Tracking;
    for (const double extinction : {1e4, 1e9, 1e30}) {
        MediumScene scene(sceneOf({volumeOf(blob, extinction)}), options);
        const Ray through{kBlobMiddle + Vec3d(0, 0, 50), Vec3d(0, 0, -1)};
        EXPECT_EQ(scene.along(through).left, 0) << extinction;
        EXPECT_LT(scene.left(through), 1e-5) << extinction;
        // Seen at its rim, where there is next to nothing of it.
        EXPECT_GT(scene.along(through).depth, 30) << extinction;
        EXPECT_LT(scene.along(through).depth, 47) << extinction;
    }
}

TEST(Transmittance, VolumesStepByTheirOwnVoxels) {
    // One a thousandth as large as the other, beside it and in it.
    const auto large = blobGrid(6), small = blobGrid(3);
    const auto transform = openvdb::math::Transform::createLinearTransform(1e-3);
    const Vec3d shift = kBlobMiddle - transform->indexToWorld(kBlobMiddle);
    transform->postTranslate(shift);
    small->setTransform(transform);
    MediumScene both(sceneOf({volumeOf(large, 0.1), volumeOf(small, 100)}), {});
    MediumScene alone(sceneOf({volumeOf(large, 0.1)}), {});
    MediumScene other(sceneOf({volumeOf(small, 100)}), {});
    const Ray through{kBlobMiddle + Vec3d(0, 0, 100), Vec3d(0, 0, -1)};
    EXPECT_NEAR(both.left(through), alone.left(through) * other.left(through), 1e-4);
    EXPECT_NEAR(both.along(through).left, both.left(through), 1e-4);
}

TEST(Tracking, IsRightForTwoVolumes) {
    const auto first = blobGrid(4), second = blobGrid(2);
    PictureOptions options;
    options.volumes.method = VolumeOptions::Method::Tracking;
    Scene scene = sceneOf({volumeOf(first, 0.1), volumeOf(second, 0.2)});
    // They shine in different colours: each stops its part of the light.
    scene.objects[0].medium.emission = Vec3d(1, 0, 0);
    scene.objects[1].medium.emission = Vec3d(0, 1, 0);
    MediumScene random(scene, options);
    MediumScene steps(scene, {});
    const Ray ray{kBlobMiddle + Vec3d(1, 0, 60), Vec3d(0, 0, -1)};
    const MediumLight expected = steps.along(ray);
    constexpr int kWays = 4000;
    Vec3d light(0.0);
    for (int i = 0; i < kWays; ++i) light += random.along(ray, i).light / kWays;
    for (int c = 0; c < 2; ++c) {
        EXPECT_NEAR(light[c], expected.light[c],
                    4 * std::sqrt(expected.light[c] * (1 - expected.light[c]) / kWays) + 2e-3);
    }
}

}  // namespace
}  // namespace bandvox

#include "render/lamps.h"

#include "render/scene_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::BBoxd;
using openvdb::Vec3d;
using std::numbers::pi;

const double kBall = ballSurface(kRadius, 0.5);
const Vec3d kBallMiddle(0, 0, 30);

// A ball over a floor at z = 0, lit by one lamp alone.
Scene shadowScene(const Light& lamp) {
    Material white;
    white.color = Vec3d(1.0);
    Scene scene;
    scene.objects = {surfaceOf(boxGrid(BBoxd(Vec3d(-60, -50, -12), Vec3d(60, 50, 0))), white),
                     surfaceOf(ballAt(kBallMiddle), white)};
    scene.environment.color = Vec3d(0.0);
    scene.lights = {lamp};
    return scene;
}

Light worldLamp(Light::Kind kind, const Vec3d& place, double size = 0) {
    Light lamp;
    lamp.kind = kind;
    lamp.followsCamera = false;
    lamp.place = place;
    lamp.color = Vec3d(0.8);
    lamp.size = size;
    return lamp;
}

// How far inside the ball a line passes.
double insideBall(const Vec3d& place, const Vec3d& direction) {
    const Vec3d offset = kBallMiddle - place;
    if (offset.dot(direction) < 0) return -1;
    return kBall - offset.cross(direction).length();
}

PictureOptions shadowPicture(int side) {
    PictureOptions options = pictureFrom({0, -1, 1.2}, {0, 0, 0}, side, 110);
    options.camera.up = Vec3d(0, 0, 1);
    options.transport.shadows = true;
    return options;
}

Camera anyCamera() {
    CameraOptions options;
    options.lookat = Vec3d(0.0);
    options.eye = Vec3d(1, 2, 30);
    return Camera(options, 10, 10, std::vector<Vec3d>{Vec3d(0.0)});
}

class EachKind : public testing::TestWithParam<Light::Kind> {};

TEST_P(EachKind, ThrowsAHardShadowWhereGeometrySays) {
    const bool isPoint = GetParam() == Light::Kind::Point;
    const Vec3d place = isPoint ? Vec3d(20, 10, 90) : Vec3d(0.5, 0.3, 1);
    const Image image =
        sceneToImage(shadowScene(worldLamp(GetParam(), place)), shadowPicture(60)).image;
    int dark = 0, lit = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        if (std::isinf(image.depth[i])) continue;
        const Vec3d at = positionAt(image, i);
        if (at[2] > 0.1 || std::abs(at[0]) > 50 || std::abs(at[1]) > 40) continue;
        const Vec3d direction = isPoint ? (place - at).unit() : place.unit();
        const double inside = insideBall(at, direction);
        const double distance = isPoint ? (place - at).length() : 1;
        const double open = 0.8 * direction[2] / (distance * distance);
        if (inside > 0.05) {
            EXPECT_EQ(image.color[4 * i], 0) << at;
            ++dark;
        } else if (inside < -0.05) {
            // The square of the distance, and Lambert's cosine.
            EXPECT_NEAR(image.color[4 * i] / open, 1, 1e-3) << at;
            ++lit;
        }
    }
    EXPECT_GT(dark, 100);
    EXPECT_GT(lit, 500);
}

TEST_P(EachKind, ThrowsAShadowAsSoftAsItsDisk) {
    const bool isPoint = GetParam() == Light::Kind::Point;
    const Vec3d place = isPoint ? Vec3d(15, 10, 110) : Vec3d(0.3, 0.2, 1);
    const Light lamp = worldLamp(GetParam(), place, 14);
    PictureOptions options = shadowPicture(12);
    options.samples = 256;
    options.camera.frame = 1e-3;  // all of it one place
    const Lamps lamps({lamp}, anyCamera());
    int half = 0;
    for (const double along : {-31.0, -28.0, -25.0, -18.0, -12.0, -6.0, 4.0}) {
        const Vec3d at(-9, along, 0);
        options.width = options.height = 2;
        options.camera.lookat = at;
        options.camera.eye = at + Vec3d(-30, -10, 14);
        const Image image = sceneToImage(shadowScene(lamp), options).image;
        double expected = 0;
        constexpr int kSide = 128;
        for (int i = 0; i < kSide * kSide; ++i) {
            const auto sample =
                lamps.sample(0, at, {(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
            if (insideBall(at, sample.direction) > 0) continue;
            expected += sample.color[0] * sample.direction[2] / (kSide * kSide);
        }
        const double open = isPoint ? 0.8 / (place - at).lengthSqr() : 0.8;
        double found = 0;
        for (int i = 0; i < 4; ++i) found += image.color[4 * i] / 4;
        EXPECT_NEAR(found / open, expected / open, 1e-2) << along;
        if (expected > 0.1 * open && expected < 0.8 * open) ++half;
    }
    EXPECT_GE(half, 1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EachKind,
                         testing::Values(Light::Kind::Directional, Light::Kind::Point));

TEST(Lamps, AreADiskOfEqualSolidAngles) {
    for (const double degrees : {0.5, 10.0, 60.0, 180.0}) {
        const Vec3d towards = Vec3d(0.2, -0.5, 0.8).unit();
        const Lamps lamps({worldLamp(Light::Kind::Directional, towards, degrees)}, anyCamera());
        const double edge = std::cos(0.5 * degrees * pi / 180);
        constexpr int kSide = 100;
        Vec3d mean(0.0);
        double lowest = 1;
        for (int i = 0; i < kSide * kSide; ++i) {
            const auto sample =
                lamps.sample(0, {3, 4, 5}, {(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
            ASSERT_NEAR(sample.direction.length(), 1, 1e-9);
            EXPECT_TRUE(std::isinf(sample.distance));
            lowest = std::min(lowest, sample.direction.dot(towards));
            mean += sample.direction / (kSide * kSide);
        }
        // Evenly over a cap, the mean height is that of its middle.
        EXPECT_LT((mean - 0.5 * (1 + edge) * towards).length(), 1e-3) << degrees;
        EXPECT_GE(lowest, edge - 1e-9);
        EXPECT_LT(lowest, edge + 0.03 * (1 - edge));
        // What a mirror sees of it, spread over its cap, is its light.
        const double seen = lamps.seenAlong(towards)[0];
        EXPECT_NEAR(seen * 2 * pi * (1 - edge), 0.8 * pi, 1e-9);
        EXPECT_EQ(lamps.seenAlong(-towards)[0], 0);
    }
}

TEST(Lamps, OfNoSizeAreAPoint) {
    const Lamps lamps(
        {worldLamp(Light::Kind::Directional, {0, 3, 4}), worldLamp(Light::Kind::Point, {0, 0, 10})},
        anyCamera());
    EXPECT_LT((lamps.sample(0, {1, 1, 1}, {0.9, 0.1}).direction - Vec3d(0, 0.6, 0.8)).length(),
              1e-12);
    const auto sample = lamps.sample(1, {0, 0, 7}, {0.9, 0.1});
    EXPECT_LT((sample.direction - Vec3d(0, 0, 1)).length(), 1e-12);
    EXPECT_NEAR(sample.distance, 3, 1e-12);
    EXPECT_NEAR(sample.color[1], 0.8 / 9, 1e-12);
    EXPECT_EQ(lamps.sample(1, {0, 0, 10}, {0.5, 0.5}).color, Vec3d(0.0));
    EXPECT_EQ(lamps.seenAlong({0, 0.6, 0.8}), Vec3d(0.0));
}

TEST(Lamps, FollowTheCameraIfTheyShould) {
    const Camera camera = anyCamera();
    Light distant, point;
    distant.place = Vec3d(1, 2, 3);
    point.kind = Light::Kind::Point;
    point.place = Vec3d(1, 2, 3);
    const Lamps lamps({distant, point}, camera);
    const Vec3d expected = camera.right() + 2 * camera.upward() - 3 * camera.forward();
    EXPECT_LT((lamps.sample(0, {9, 9, 9}, {0, 0}).direction - expected.unit()).length(), 1e-12);
    const auto sample = lamps.sample(1, camera.eye(), {0, 0});
    EXPECT_LT((sample.direction * sample.distance - expected).length(), 1e-12);
}

TEST(Lamps, OfASmallSizeShineAsThoseOfNone) {
    const auto brightness = [](Light::Kind kind, double size) {
        const Vec3d place = kind == Light::Kind::Point ? Vec3d(10, 0, 80) : Vec3d(0.3, 0, 1);
        PictureOptions options = shadowPicture(1);
        options.camera.lookat = Vec3d(-45, 30, 0);
        options.camera.eye = Vec3d(-45, 10, 20);
        options.camera.frame = 1e-3;
        options.samples = 64;
        return double(
            sceneToImage(shadowScene(worldLamp(kind, place, size)), options).image.color[0]);
    };
    for (const auto kind : {Light::Kind::Directional, Light::Kind::Point}) {
        const double sharp = brightness(kind, 0);
        EXPECT_GT(sharp, 0);
        EXPECT_NEAR(brightness(kind, 0.1) / sharp, 1, 1e-4);
        EXPECT_NEAR(brightness(kind, 3) / sharp, 1, 5e-3);
    }
}

TEST(Lamps, AreSeenInMirrors) {
    Material mirror;
    mirror.reflectance = 1;
    mirror.roughness = 0;
    Scene scene;
    scene.objects = {surfaceOf(ballAt(Vec3d(0.0)), mirror)};
    scene.environment.color = Vec3d(0.25);
    const Vec3d towards = Vec3d(0.4, 0.3, 0.8).unit();
    scene.lights = {worldLamp(Light::Kind::Directional, towards, 20)};
    const Image image = sceneToImage(scene, pictureFrom({0, 0, 1}, Vec3d(0.0), 80, 36)).image;
    const double edge = std::cos(10 * pi / 180);
    int seen = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        if (std::isinf(image.depth[i])) continue;
        const Vec3d normal = normalAt(image, i);
        const Vec3d mirrored = 2 * normal[2] * normal - Vec3d(0, 0, 1);
        const double above = mirrored.dot(towards) - edge;
        if (std::abs(above) < 1e-4) continue;
        const double sun = above > 0 ? 0.8 / (2 * (1 - edge)) : 0;
        EXPECT_NEAR(image.color[4 * i], 0.25 + sun, 1e-5);
        if (above > 0) ++seen;
    }
    EXPECT_GT(seen, 10);
}

}  // namespace
}  // namespace bandvox

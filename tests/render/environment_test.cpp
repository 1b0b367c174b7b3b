#include "render/environment.h"

#include "render/scene_pieces.h"

#include <bandvox/core/error.h>
#include <bandvox/render/image.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

// A map of what `light` is in each direction.
PixelArray mapOf(int width, int height, const std::function<Vec3d(const Vec3d&)>& light) {
    PixelArray map{width, height, 3, {}};
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const double polar = pi * (row + 0.5) / height;
            const double around = 2 * pi * (column + 0.5) / width;
            // The middle is along -z, the left quarter along -x.
            const Vec3d color = light({-std::sin(polar) * std::sin(around), std::cos(polar),
                                       std::sin(polar) * std::cos(around)});
            for (int c = 0; c < 3; ++c) map.values.push_back(static_cast<float>(color[c]));
        }
    }
    return map;
}

std::vector<Vec3d> directions(int count) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> all;
    for (int i = 0; i < count; ++i) {
        all.push_back(Vec3d(normal(random), normal(random), normal(random)).unit());
    }
    return all;
}

// ∫ f dω by midpoints.
Vec3d overSphere(int steps, const std::function<Vec3d(const Vec3d&)>& f) {
    Vec3d sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double y = 1 - 2 * (i + 0.5) / steps, across = std::sqrt(1 - y * y);
        for (int j = 0; j < 2 * steps; ++j) {
            const double around = pi * (j + 0.5) / steps;
            sum += f({across * std::cos(around), y, across * std::sin(around)});
        }
    }
    return sum * (4 * pi / (2.0 * steps * steps));
}

Vec3d smoothLight(const Vec3d& d) {
    return {1 + 0.5 * d[0] + 0.3 * d[1] * d[2], 0.4 + 0.3 * d[1],
            1 + d[2] * d[2] - 0.2 * d[0] * d[1]};
}

TEST(EnvironmentMap, IsSeenWhereItsHeaderSays) {
    PixelArray map{8, 4, 3, std::vector<float>(8 * 4 * 3, 0.0F)};
    const auto set = [&](int column, int channel) {
        for (int row = 0; row < 4; ++row) map.values[3 * (8 * row + column) + channel] = 1;
    };
    set(3, 0), set(4, 0);  // red in the middle
    set(1, 1), set(2, 1);  // green at the left quarter
    set(5, 2), set(6, 2);  // blue at the right quarter
    const EnvironmentMap around(map, 0, "test");
    EXPECT_LT((around.radiance({0, 0, -1}) - Vec3d(1, 0, 0)).length(), 1e-6);
    EXPECT_LT((around.radiance({-1, 0, 0}) - Vec3d(0, 1, 0)).length(), 1e-6);
    EXPECT_LT((around.radiance({1, 0, 0}) - Vec3d(0, 0, 1)).length(), 1e-6);
    EXPECT_LT(around.radiance({0, 0, 1}).length(), 1e-6);
    // Turned by a quarter, from above against the clock, what was in front is at the left.
    const EnvironmentMap turned(map, 90, "test");
    EXPECT_LT((turned.radiance({-1, 0, 0}) - Vec3d(1, 0, 0)).length(), 1e-6);
    EXPECT_LT((turned.radiance({0, 0, 1}) - Vec3d(0, 1, 0)).length(), 1e-6);
    EXPECT_LT((turned.radiance({0, 0, -1}) - Vec3d(0, 0, 1)).length(), 1e-6);
}

TEST(EnvironmentMap, HasItsFirstRowAbove) {
    const EnvironmentMap around(
        mapOf(16, 8, [](const Vec3d& d) { return Vec3d(d[1] > 0 ? 1.0 : 0.0); }), 0, "test");
    EXPECT_EQ(around.radiance({0, 1, 0}), Vec3d(1.0));
    EXPECT_EQ(around.radiance(Vec3d(0.3, -1, 0.1).unit()), Vec3d(0.0));
    EXPECT_NEAR(around.radiance({1, 0, 0})[0], 0.5, 1e-6);
}

TEST(EnvironmentMap, FollowsSmoothLightInAllDirections) {
    for (const double turn : {0.0, 33.0, -120.0}) {
        const EnvironmentMap around(mapOf(256, 128, smoothLight), turn, "test");
        const double s = std::sin(turn * pi / 180), c = std::cos(turn * pi / 180);
        for (const Vec3d& d : directions(200)) {
            const Vec3d turned(c * d[0] + s * d[2], d[1], -s * d[0] + c * d[2]);
            EXPECT_LT((around.radiance(turned) - smoothLight(d)).length(), 2e-3);
        }
    }
    // Over the seam behind and at the poles.
    const EnvironmentMap around(mapOf(256, 128, smoothLight), 0, "test");
    for (const double hair : {-1e-9, 1e-9, -0.01, 0.01}) {
        const Vec3d behind = Vec3d(hair, 0.2, 1).unit(), up = Vec3d(hair, 1, 0.3 * hair).unit();
        EXPECT_LT((around.radiance(behind) - smoothLight(behind)).length(), 2e-3);
        EXPECT_LT((around.radiance(up) - smoothLight(up)).length(), 2e-2);
        EXPECT_LT((around.radiance(-up) - smoothLight(-up)).length(), 2e-2);
    }
}

TEST(EnvironmentMap, LightsMattSurfacesAsQuadratureDoes) {
    for (const double turn : {0.0, 47.0}) {
        const EnvironmentMap around(mapOf(128, 64, smoothLight), turn, "test");
        for (const Vec3d& normal : directions(8)) {
            const Vec3d expected = overSphere(200, [&](const Vec3d& d) {
                return around.radiance(d) * std::max(d.dot(normal), 0.0) / pi;
            });
            EXPECT_LT((around.irradiance(normal) - expected).length(), 3e-3);
        }
    }
}

TEST(EnvironmentMap, IsGatheredAsQuadratureHasIt) {
    // A small bright window, which directions by the cosine alone would seldom find.
    const auto window = [](const Vec3d& d) {
        return d.dot(Vec3d(0.48, 0.36, 0.8)) > 0.99 ? Vec3d(60, 40, 20) : Vec3d(0.2, 0.3, 0.4);
    };
    const auto map = std::make_shared<const EnvironmentMap>(mapOf(128, 64, window), 0, "test");
    const Vec3d expected = overSphere(
        400, [&](const Vec3d& d) { return map->radiance(d) * std::max(d[2], 0.0) / pi; });
    Material white;
    white.color = Vec3d(1.0);
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), white)};
    scene.environment = {Vec3d(1.0), map, false};
    PictureOptions options = pictureFrom({0, 0, 1}, kCenter, 1, 0.5);
    options.samples = 2048;
    options.transport.gather = 16;
    for (const int bounces : {0, 1}) {
        options.transport.bounces = bounces;
        const Vec3d found = colorAt(sceneToImage(scene, options).image, 0, 0);
        EXPECT_LT((found - expected).length(), 0.025 * expected.length()) << bounces << found;
    }
}

TEST(EnvironmentMap, KnowsItsMean) {
    const auto spot = [](const Vec3d& d) {
        return Vec3d(d.dot(Vec3d(0.6, 0.64, 0.48)) > 0.95 ? 40.0 : 0.0, 0.2, 1 + d[1]);
    };
    const EnvironmentMap around(mapOf(256, 128, spot), 20, "test");
    const Vec3d mean =
        overSphere(400, [&](const Vec3d& d) { return around.radiance(d); }) / (4 * pi);
    EXPECT_LT((around.mean() - mean).length(), 5e-3 * mean.length());
}

TEST(EnvironmentMap, DrawsDirectionsByBrightness) {
    const auto light = [](const Vec3d& d) {
        return Vec3d(0.1 + std::pow(std::max(d.dot(Vec3d(0.6, 0.64, -0.48)), 0.0), 60) * 50);
    };
    for (const double turn : {0.0, 75.0}) {
        const EnvironmentMap around(mapOf(128, 64, light), turn, "test");
        const Vec3d all = overSphere(300, [&](const Vec3d& d) { return Vec3d(around.density(d)); });
        EXPECT_NEAR(all[0], 1, 2e-3);
        // The mean of light over density is its integral.
        constexpr int kSide = 200;
        Vec3d sum(0.0), place(0.0);
        for (int i = 0; i < kSide * kSide; ++i) {
            const auto sample =
                around.sample({(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
            ASSERT_NEAR(sample.direction.length(), 1, 1e-9);
            ASSERT_GT(sample.density, 0);
            const Vec3d part = around.radiance(sample.direction) / sample.density;
            sum += part / (kSide * kSide);
            place += part[0] * sample.direction / (kSide * kSide);
        }
        const Vec3d expected = overSphere(300, [&](const Vec3d& d) { return around.radiance(d); });
        const Vec3d where =
            overSphere(300, [&](const Vec3d& d) { return around.radiance(d)[0] * d; });
        EXPECT_NEAR(sum[0] / expected[0], 1, 3e-3);
        EXPECT_LT((place - where).length(), 3e-3 * where.length());
    }
}

TEST(EnvironmentMap, OfFewPixelsLightsAsOneOfMany) {
    for (const int height : {1, 2, 5, 40}) {
        const EnvironmentMap white(
            mapOf(2 * height, height, [](const Vec3d&) { return Vec3d(1.0); }), 0, "test");
        for (const Vec3d& normal : directions(6)) {
            EXPECT_LT((white.irradiance(normal) - Vec3d(1.0)).length(), 2e-3) << height;
        }
    }
}

TEST(EnvironmentMap, MayBeBlackOrOfOnePixelOrGrey) {
    const EnvironmentMap black(PixelArray{4, 2, 3, std::vector<float>(24, 0.0F)}, 0, "test");
    EXPECT_EQ(black.radiance({0, 1, 0}), Vec3d(0.0));
    EXPECT_NEAR(black.sample({0.3, 0.8}).direction.length(), 1, 1e-9);
    const EnvironmentMap one(PixelArray{1, 1, 1, {0.7F}}, 10, "test");
    for (const Vec3d& d : directions(20)) EXPECT_NEAR(one.radiance(d)[2], 0.7F, 1e-12);
    EXPECT_NEAR(one.mean()[1], 0.7, 1e-5);
}

class EnvironmentFile : public testing::Test {
  protected:
    EnvironmentFile() {
        mFolder = std::filesystem::temp_directory_path() /
                  ("bandvox_environment_" + std::to_string(std::random_device()()));
        std::filesystem::create_directories(mFolder);
    }
    ~EnvironmentFile() override {
        std::error_code ignored;
        std::filesystem::remove_all(mFolder, ignored);
    }
    std::filesystem::path mFolder;
};

TEST_F(EnvironmentFile, IsRead) {
    Image image;
    image.width = 8;
    image.height = 4;
    image.color.assign(4 * 32, 1.0F);
    image.depth.assign(32, 1.0F);
    image.normal.assign(96, 0.0F);
    image.position.assign(96, 0.0F);
    for (int row = 0; row < 4; ++row) image.color[4 * (8 * row + 4) + 1] = 3;  // green
    const auto path = mFolder / "around.exr";
    writeImage(path, image);
    const auto map = readEnvironmentMap(path);
    const double around = pi / 8;
    EXPECT_LT(
        (map->radiance(Vec3d(std::sin(around), 0, -std::cos(around))) - Vec3d(1, 3, 1)).length(),
        1e-3);
    EXPECT_NEAR(map->radiance({0, 0, 1})[1], 1, 1e-6);
    EXPECT_NEAR(readEnvironmentMap(path, 180)->radiance({0, 0, -1})[1], 1, 1e-6);
}

ErrorKind kindOf(const std::function<void()>& action, const std::string& part) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorKind::Runtime;
}

TEST_F(EnvironmentFile, IsRefusedIfItIsNone) {
    EXPECT_EQ(kindOf([&] { readEnvironmentMap(mFolder / "missing.exr"); }, "missing.exr"),
              ErrorKind::Input);
    std::ofstream(mFolder / "text.exr") << "not an image\n";
    EXPECT_EQ(kindOf([&] { readEnvironmentMap(mFolder / "text.exr"); }, "text.exr"),
              ErrorKind::Input);
    for (const float bad : {-1.0F, std::nanf(""), std::numeric_limits<float>::infinity()}) {
        PixelArray map{2, 1, 3, {1, 1, 1, 1, bad, 1}};
        EXPECT_EQ(kindOf([&] { EnvironmentMap(map, 0, "sky.exr"); }, "sky.exr"), ErrorKind::Input);
    }
}

}  // namespace
}  // namespace bandvox

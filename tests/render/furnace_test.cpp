#include "render/environment.h"
#include "render/scene_pieces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Vec3d;

constexpr int kSide = 16;
constexpr double kFrame = 40;

// The pixels of a ball, but for its rim.
struct Disk {
    double mean = 0, lowest = 1e9, highest = -1e9, deviation = 0;
    int pixels = 0;
};

Disk diskOf(const Image& image) {
    Disk disk;
    double squares = 0;
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const double x = (column + 0.5) / image.width - 0.5,
                         y = (row + 0.5) / image.height - 0.5;
            if (std::hypot(x, y) * kFrame > kRadius - 2.5) continue;
            const double value = colorAt(image, column, row)[1];
            ++disk.pixels;
            disk.mean += value;
            squares += value * value;
            disk.lowest = std::min(disk.lowest, value);
            disk.highest = std::max(disk.highest, value);
        }
    }
    disk.mean /= disk.pixels;
    disk.deviation = std::sqrt(std::max(squares / disk.pixels - disk.mean * disk.mean, 0.0));
    return disk;
}

Image ballInFurnace(const Material& material, const PictureOptions& options) {
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), material)};
    scene.environment = furnace();
    return sceneToImage(scene, options).image;
}

PictureOptions ballPicture() {
    return pictureFrom({0, 0, 1}, kCenter, kSide, kFrame);
}

TEST(Furnace, AWhiteBallVanishesWhateverItsCoat) {
    PictureOptions options = ballPicture();
    options.samples = 64;
    options.transport.shadows = true;
    options.transport.gather = 2;
    for (const int bounces : {0, 2}) {
        options.transport.bounces = bounces;
        for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
            for (const double reflectance : {0.0, 0.04, 0.5, 1.0}) {
                Material material;
                material.color = Vec3d(1.0);
                material.roughness = roughness;
                material.reflectance = reflectance;
                const Disk disk = diskOf(ballInFurnace(material, options));
                ASSERT_GT(disk.pixels, 80);
                EXPECT_NEAR(disk.mean, 1, 5e-3) << roughness << " " << reflectance;
                EXPECT_GT(disk.lowest, 0.9) << roughness << " " << reflectance;
                EXPECT_LT(disk.highest, 1.1) << roughness << " " << reflectance;
            }
        }
    }
}

TEST(Furnace, AMattBallIsExactlyItsColor) {
    for (const double color : {1.0, 0.5, 0.0}) {
        Material material;
        material.color = Vec3d(color);
        const Disk disk = diskOf(ballInFurnace(material, ballPicture()));
        EXPECT_NEAR(disk.lowest, color, 1e-6);
        EXPECT_NEAR(disk.highest, color, 1e-6);
        // Nothing is in the way of a convex body.
        PictureOptions gathering = ballPicture();
        gathering.transport.gather = 3;
        gathering.transport.bounces = 3;
        const Disk gathered = diskOf(ballInFurnace(material, gathering));
        EXPECT_NEAR(gathered.lowest, color, 1e-6);
        EXPECT_NEAR(gathered.highest, color, 1e-6);
    }
}

Image twoBalls(double color, const TransportOptions& transport, int samples) {
    Material material;
    material.color = Vec3d(color);
    Scene scene;
    scene.objects = {surfaceOf(ballAt({-17.5, 0, 0}), material),
                     surfaceOf(ballAt({17.5, 0, 0}), material)};
    scene.environment = furnace();
    PictureOptions options = pictureFrom({0, 0, 1}, Vec3d(0.0), 20, 20);
    options.samples = samples;
    options.transport = transport;
    return sceneToImage(scene, options).image;
}

TEST(Furnace, LightBetweenBallsIsLostOnlyWhereBouncesEnd) {
    double before = 0;
    for (const int bounces : {0, 1, 3, 12}) {
        TransportOptions transport;
        transport.gather = 1;
        transport.bounces = bounces;
        const Image image = twoBalls(1, transport, 64);
        double sum = 0;
        int pixels = 0;
        for (std::size_t i = 0; i < image.depth.size(); ++i) {
            if (std::isinf(image.depth[i]) || image.color[4 * i + 3] < 1) continue;
            EXPECT_LT(image.color[4 * i], 1 + 1e-6);
            sum += image.color[4 * i];
            ++pixels;
        }
        ASSERT_GT(pixels, 200);
        EXPECT_GT(sum / pixels, before + (bounces == 12 ? -1e-2 : 0));
        before = sum / pixels;
        if (bounces == 0) {
            EXPECT_LT(before, 0.9);
        }
        if (bounces == 12) {
            EXPECT_GT(before, 0.985);
        }
    }
}

TEST(Furnace, NothingIsInTheWayBeyondTheDistanceToGather) {
    for (const int bounces : {0, 2}) {
        TransportOptions transport;
        transport.gather = 1;
        transport.bounces = bounces;
        const auto middle = [&](double distance) {
            transport.gatherDistance = distance;
            const Image image = twoBalls(0.0001, transport, 16);  // hardly any light goes on
            double sum = 0;
            for (int column = 0; column < 4; ++column) sum += colorAt(image, column, 10)[0] / 4;
            return sum / 0.0001;
        };
        EXPECT_NEAR(middle(1e-3), 1, 1e-4);
        EXPECT_LT(middle(0), 0.97);
        EXPECT_LT(middle(0), middle(12) - 0.01);
    }
}

std::shared_ptr<const EnvironmentMap> waves() {
    PixelArray map{64, 32, 3, {}};
    for (int row = 0; row < 32; ++row) {
        for (int column = 0; column < 64; ++column) {
            map.values.push_back(static_cast<float>(0.5 + 0.4 * std::sin(0.196 * column)));
            map.values.push_back(static_cast<float>(row / 32.0));
            map.values.push_back(static_cast<float>(0.5 + 0.3 * std::cos(0.4 * row)));
        }
    }
    return std::make_shared<const EnvironmentMap>(map, 0, "waves");
}

TEST(Mirror, ShowsWhatIsAround) {
    Material material;
    material.reflectance = 1;
    material.roughness = 0;
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), material)};
    scene.environment = furnace();
    scene.environment.map = waves();
    const Image image = sceneToImage(scene, pictureFrom({0.3, 0.2, 1}, kCenter, 24, 40)).image;
    const Vec3d forward = -Vec3d(0.3, 0.2, 1).unit();
    int seen = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        if (std::isinf(image.depth[i])) continue;
        const Vec3d normal = normalAt(image, i);
        const Vec3d expected =
            scene.environment.map->radiance((forward - 2 * forward.dot(normal) * normal).unit());
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.color[4 * i + c], expected[c], 1e-5);
        ++seen;
    }
    EXPECT_GT(seen, 200);
}

TEST(Mirror, IsBlackIfNothingMayBeMirrored) {
    Material material;
    material.reflectance = 1;
    material.roughness = 0;
    PictureOptions options = ballPicture();
    options.transport.depth = 0;
    EXPECT_EQ(diskOf(ballInFurnace(material, options)).highest, 0);
    options.transport.depth = 1;
    EXPECT_NEAR(diskOf(ballInFurnace(material, options)).lowest, 1, 1e-6);
}

}  // namespace
}  // namespace bandvox

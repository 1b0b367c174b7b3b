#include "render/environment.h"
#include "render/facets.h"
#include "render/scene_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::BBoxd;
using openvdb::Vec3d;

Material glass(double index, double roughness = 0) {
    Material material;
    material.transparency = 1;
    material.roughness = roughness;
    material.refractiveIndex = index;
    return material;
}

// White above, black below.
std::shared_ptr<const EnvironmentMap> sky() {
    PixelArray map{16, 8, 3, std::vector<float>(16 * 8 * 3, 0.0F)};
    std::fill_n(map.values.begin(), 16 * 4 * 3, 1.0F);
    return std::make_shared<const EnvironmentMap>(map, 0, "sky");
}

TEST(Glass, OfNoRefractionIsInvisible) {
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), glass(1))};
    scene.environment = furnace();
    scene.environment.visible = true;
    scene.environment.map = sky();
    PictureOptions options;
    options.width = 40;
    options.height = 30;
    const Image with = sceneToImage(scene, options).image;
    options.camera.from = {0.55, 0.35, 1};
    Scene without = scene;
    without.objects[0].iso = 2;  // nothing is as dense
    options.allowEmpty = true;
    const Image empty = sceneToImage(without, options).image;
    int glassy = 0;
    for (std::size_t i = 0; i < with.depth.size(); ++i) {
        if (std::isfinite(with.depth[i])) ++glassy;
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(with.color[4 * i + c], empty.color[4 * i + c], 1e-6);
    }
    EXPECT_GT(glassy, 200);
}

TEST(Glass, KeepsTheLight) {
    for (const double index : {1.2, 1.5, 2.4}) {
        for (const double roughness : {0.0, 0.2, 0.6}) {
            Scene scene;
            scene.objects = {surfaceOf(ballGrid(), glass(index, roughness))};
            scene.environment = furnace();
            scene.environment.visible = true;
            PictureOptions options = pictureFrom({0, 0, 1}, kCenter, 16, 40);
            options.transport.depth = 16;
            options.samples = 16;
            const Image image = sceneToImage(scene, options).image;
            double mean = 0;
            for (std::size_t i = 0; i < image.depth.size(); ++i) {
                const double value = image.color[4 * i];
                mean += value / image.depth.size();
                // No branch sends on more than it gets, nor do all of them.
                EXPECT_LE(value, 1 + 1e-6);
                EXPECT_GE(value, roughness == 0 ? 0.97 : 0.3) << index << " " << i;
            }
            EXPECT_GT(mean, roughness == 0    ? 0.97
                            : roughness < 0.5 ? 0.95
                                              : 0.65)
                << index << " " << roughness;
        }
    }
}

TEST(Glass, BallTurnsWhatIsBehindUpsideDown) {
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), glass(1.5))};
    scene.environment = furnace();
    scene.environment.visible = true;
    scene.environment.map = sky();
    const Image image = sceneToImage(scene, pictureFrom({0, 0, 1}, kCenter, 41, 41)).image;
    // Seen straight on, half the horizon is white; what passes above the middle goes down.
    for (const int row : {11, 14, 16}) {
        EXPECT_LT(colorAt(image, 20, row)[0], 0.2) << row;
        EXPECT_GT(colorAt(image, 20, 40 - row)[0], 0.8) << row;
    }
}

TEST(Glass, BallBendsAsSnellSays) {
    // A map that tells how high its rows are: where the light that passes comes from.
    PixelArray map{4, 512, 3, {}};
    for (int row = 0; row < 512; ++row) {
        for (int i = 0; i < 12; ++i) {
            map.values.push_back(static_cast<float>((row + 0.5) / 512));
        }
    }
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), glass(1.5))};
    scene.environment = furnace();
    scene.environment.map = std::make_shared<const EnvironmentMap>(map, 0, "rows");
    PictureOptions options = pictureFrom({0, 0, 1}, kCenter, 41, 41);
    options.transport.depth = 2;  // through, or mirrored twice
    const Image image = sceneToImage(scene, options).image;
    const double radius = ballSurface(kRadius, 0.5);
    for (int row = 8; row < 20; ++row) {
        const double sine = (20 - row) / radius;
        const double outside = std::asin(sine), inside = std::asin(sine / 1.5);
        const double lost = fresnel(std::cos(outside), 1.5);
        // Rows count angles from straight up.
        const double along = 0.5 + 2 * (outside - inside) / std::numbers::pi;
        const double mirrored = 0.5 - (std::numbers::pi - 2 * outside) / std::numbers::pi;
        // Mirrored once inside, it would leave at a third meeting, which is one too many.
        const double expected =
            (1 - lost) * (1 - lost) * along + lost * (mirrored < 0 ? -mirrored : mirrored);
        EXPECT_NEAR(colorAt(image, 20, row)[1], expected, 2e-3) << row;
    }
}

// The middle of what is brighter than the corner, which the slab mirrors evenly.
Vec3d middleOfBright(const Image& image, double frame) {
    double x = 0, y = 0, all = 0;
    const double corner = colorAt(image, 0, 0)[0];
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const double light = colorAt(image, column, row)[0] - corner;
            x += light * (column + 0.5);
            y += light * (row + 0.5);
            all += light;
        }
    }
    return Vec3d(x / all, y / all, 0) * (frame / image.width);
}

TEST(Glass, SlabShiftsWhatIsBehind) {
    const double thickness = 14, degrees = 40;
    const auto slab = boxGrid(BBoxd(Vec3d(-66, -40, 0), Vec3d(66, 40, thickness)));
    Material white;
    white.color = Vec3d(1.0);
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3d view(std::sin(angle), 0, std::cos(angle));
    PictureOptions options = pictureFrom(view, {0, 0, 0}, 80, 60);
    options.camera.up = Vec3d(0, 1, 0);
    options.background = Vec3d(0.0);
    options.samples = 4;
    Scene scene;
    scene.objects = {surfaceOf(ballAt(-24 * view), white)};
    scene.environment = furnace();
    const Vec3d alone = middleOfBright(sceneToImage(scene, options).image, 60);
    for (const double index : {1.3, 1.5, 2.0}) {
        scene.objects.resize(1);
        scene.objects.push_back(surfaceOf(slab, glass(index)));
        const Vec3d shift = middleOfBright(sceneToImage(scene, options).image, 60) - alone;
        const double sine = std::sin(angle), cosine = std::cos(angle);
        const double expected =
            thickness * sine * (1 - cosine / std::sqrt(index * index - sine * sine));
        // The eye is to the right of the normal, towards which rays are bent: they come out at the
        // right of where they would have, and show what is behind too far left.
        // Rays go on 0.02 voxels beyond each face.
        EXPECT_NEAR(shift[0], -expected, 0.03) << index;
        EXPECT_NEAR(shift[1], 0, 0.02);
    }
}

TEST(Glass, IsTintedByItsThickness) {
    const double straight = 0.04;  // of index 1.5
    for (const double thickness : {6.0, 12.5}) {
        for (const double length : {4.0, 20.0}) {
            Material material = glass(1.5);
            material.color = Vec3d(0.5, 0.9, 1);
            material.tintLength = length;
            Scene scene;
            scene.objects = {
                surfaceOf(boxGrid(BBoxd(Vec3d(-20, -20, 0), Vec3d(20, 20, thickness))), material)};
            scene.environment = furnace();
            scene.environment.visible = true;
            const Image image = sceneToImage(scene, pictureFrom({0, 0, 1}, Vec3d(0.0), 3, 6)).image;
            for (int c = 0; c < 3; ++c) {
                const double left = std::pow(material.color[c], thickness / length);
                const double again = straight * straight * left * left;
                const double once = (1 - straight) * (1 - straight) * left / (1 - again);
                const double expected = straight + once + once * straight * left;
                EXPECT_NEAR(colorAt(image, 1, 1)[c], expected, 3e-3) << thickness << " " << length;
            }
        }
    }
}

TEST(Glass, ShowsWhatIsInIt) {
    Material red;
    red.color = Vec3d(0.7, 0.1, 0.05);
    Scene scene;
    const auto cube = boxGrid(BBoxd(Vec3d(-24), Vec3d(24)));
    scene.objects = {surfaceOf(ballAt(Vec3d(0.0)), red), surfaceOf(cube, glass(1.5))};
    scene.environment = furnace();
    for (int order = 0; order < 2; ++order) {
        const Image image = sceneToImage(scene, pictureFrom({0, 0, 1}, Vec3d(0.0), 9, 18)).image;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(colorAt(image, 4, 4)[c], 0.04 + 0.96 * red.color[c], 1e-3);
        }
        std::swap(scene.objects[0], scene.objects[1]);
    }
}

TEST(Glass, MayBeAroundTheEye) {
    Material tinted = glass(1.5);
    tinted.color = Vec3d(0.25, 0.5, 1);
    tinted.tintLength = 10;
    Material white;
    white.color = Vec3d(1.0);
    Scene scene;
    scene.objects = {surfaceOf(boxGrid(BBoxd(Vec3d(-24, -24, -24), Vec3d(24, 24, 60))), tinted),
                     surfaceOf(ballAt(Vec3d(0.0)), white)};
    scene.environment = furnace();
    PictureOptions options;
    options.width = options.height = 3;
    options.camera.lookat = Vec3d(0.0);
    options.camera.eye = Vec3d(0, 0, 40);
    options.camera.aperture = 1;
    const Image image = sceneToImage(scene, options).image;
    const double way = 40 - ballSurface(kRadius, 0.5);
    EXPECT_NEAR(image.depth[4], way, 1e-3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(colorAt(image, 1, 1)[c], std::pow(tinted.color[c], way / 10), 1e-4);
    }
}

TEST(Glass, LetsLampsThroughAsFarAsItReflectsNothing) {
    // A matt floor under a slab of glass, lit from straight above.
    Material white;
    white.color = Vec3d(1.0);
    Scene scene;
    scene.objects = {surfaceOf(boxGrid(BBoxd(Vec3d(-20, -20, -30), Vec3d(20, 20, -20))), white),
                     surfaceOf(boxGrid(BBoxd(Vec3d(-20, -20, 0), Vec3d(20, 20, 10))), glass(1.5))};
    scene.environment.color = Vec3d(0.0);
    Light lamp;
    lamp.followsCamera = false;
    lamp.place = Vec3d(0, 0, 1);
    lamp.color = Vec3d(0.8);
    scene.lights = {lamp};
    PictureOptions options = pictureFrom({1, 0, -0.1}, {0, 0, -19}, 3, 1);
    options.camera.lookat = Vec3d(0, 0, -20);
    options.camera.eye = Vec3d(15, 0, -10);
    options.transport.shadows = true;
    const Image image = sceneToImage(scene, options).image;
    EXPECT_NEAR(colorAt(image, 1, 1)[0], 0.8 * 0.96 * 0.96, 1e-3);
    options.transport.shadows = false;
    EXPECT_NEAR(colorAt(sceneToImage(scene, options).image, 1, 1)[0], 0.8, 1e-3);
}

}  // namespace
}  // namespace bandvox

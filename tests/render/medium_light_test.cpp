#include "render/environment.h"
#include "render/medium_scene.h"
#include "stop_after.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::BBoxd;
using openvdb::Vec3d;
using std::numbers::pi;

Light lampFrom(const Vec3d& direction, double color = 0.8) {
    Light lamp;
    lamp.followsCamera = false;
    lamp.place = direction;
    lamp.color = Vec3d(color);
    return lamp;
}

const Ray kDown{kBlobMiddle + Vec3d(0, 0, 60), Vec3d(0, 0, -1)};

Scene blobScene(double sigma, double extinction) {
    Scene scene;
    scene.objects = {volumeOf(blobGrid(sigma), extinction)};
    scene.environment.color = Vec3d(0.0);
    return scene;
}

// A single line of sight may take long.
TEST(MediumTransport, AsksOnALineOfSightWhetherToStop) {
    for (const auto method : {VolumeOptions::Method::Steps, VolumeOptions::Method::Tracking}) {
        PictureOptions options;
        options.volumes.method = method;
        expectStopsMidway(3, [&](Progress& progress) {
            MediumScene scene(blobScene(4, 0.01), options, progress);
            scene.along(kDown);
        });
    }
}

TEST(HenyeyGreenstein, IsAllOfTheLightWithItsMeanCosine) {
    for (const double g : {-0.8, -0.3, 0.0, 0.4, 0.9}) {
        constexpr int kSteps = 20000;
        double all = 0, mean = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = -1 + 2 * (i + 0.5) / kSteps;
            all += 2 * pi * henyeyGreenstein(cosine, g) * 2 / kSteps;
            mean += 2 * pi * henyeyGreenstein(cosine, g) * cosine * 2 / kSteps;
        }
        EXPECT_NEAR(all, 1, 1e-4) << g;
        EXPECT_NEAR(mean, g, 1e-4) << g;
    }
    EXPECT_GT(henyeyGreenstein(1, 0.5), henyeyGreenstein(-1, 0.5));  // onward
}

TEST(MediumLight, OfWhatShinesIsWhatDoesNotPass) {
    for (const double extinction : {0.02, 0.2, 2.0}) {
        Scene scene = blobScene(4, extinction);
        scene.objects[0].medium.emission = Vec3d(3, 0.5, 0);
        MediumScene medium(scene, {});
        for (const Ray& ray : raysPast(kBlobMiddle, 8, 20)) {
            const MediumLight light = medium.along(ray);
            const double through = throughBlob(*scene.objects[0].grid, 4, ray);
            const double expected = 1 - std::exp(-extinction * through);
            EXPECT_NEAR(light.light[0], 3 * expected, 5e-4);
            EXPECT_NEAR(light.light[1], 0.5 * expected, 1e-4);
            EXPECT_EQ(light.light[2], 0);
        }
    }
}

// ∫ σ e^{-2τ} ds of light that comes from where the eye is, τ e^{-τ} of light that comes against
// it.
TEST(MediumLight, ScatteredOnceAlongTheViewHasAClosedForm) {
    for (const double g : {0.0, 0.6, -0.4}) {
        for (const double extinction : {0.02, 0.1}) {
            Scene scene = blobScene(5, extinction);
            scene.objects[0].medium.color = Vec3d(1, 0.5, 0.25);
            scene.objects[0].medium.anisotropy = g;
            const double depth = extinction * throughBlob(*scene.objects[0].grid, 5, kDown);
            scene.lights = {lampFrom({0, 0, 1})};
            const Vec3d back = MediumScene(scene, {}).along(kDown).light;
            scene.lights = {lampFrom({0, 0, -1})};
            const Vec3d onward = MediumScene(scene, {}).along(kDown).light;
            for (int c = 0; c < 3; ++c) {
                const double scattered = 0.8 * pi * scene.objects[0].medium.color[c];
                EXPECT_NEAR(back[c],
                            scattered * henyeyGreenstein(-1, g) * (1 - std::exp(-2 * depth)) / 2,
                            2e-3 * scattered);
                EXPECT_NEAR(onward[c],
                            scattered * henyeyGreenstein(1, g) * depth * std::exp(-depth),
                            2e-3 * scattered);
            }
        }
    }
}

TEST(MediumLight, IsTheSameByStepsAndByTracking) {
    Scene scene = blobScene(4, 0.15);
    scene.objects[0].medium.color = Vec3d(0.9);
    scene.objects[0].medium.anisotropy = 0.3;
    scene.objects[0].medium.emission = Vec3d(0, 0.2, 0);
    scene.lights = {lampFrom({0.5, 0.4, 0.6})};
    scene.environment.color = Vec3d(0, 0, 0.3);
    for (const int gather : {0, 1}) {
        PictureOptions options;
        options.transport.gather = gather;
        MediumScene steps(scene, options);
        options.volumes.method = VolumeOptions::Method::Tracking;
        MediumScene tracking(scene, options);
        constexpr int kWays = 6000;
        Vec3d one(0.0), other(0.0), squares(0.0);
        for (int i = 0; i < kWays; ++i) {
            if (i < 60) one += steps.along(kDown, i).light / 60;
            const Vec3d light = tracking.along(kDown, i).light;
            other += light / kWays;
            squares += light * light / kWays;
        }
        for (int c = 0; c < 3; ++c) {
            const double error = std::sqrt(std::max(squares[c] - other[c] * other[c], 0.0) / kWays);
            EXPECT_NEAR(one[c], other[c], 4 * error + (gather > 0 ? 1e-2 : 2e-3)) << gather << c;
        }
    }
}

TEST(MediumLight, FromAroundIsTheColorOfTheVolumeIfNothingIsInTheWay) {
    Scene scene = blobScene(4, 0.3);
    scene.objects[0].medium.color = Vec3d(0.5, 0.6, 0.7);
    scene.environment.color = Vec3d(2.0);
    const MediumLight light = MediumScene(scene, {}).along(kDown);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(light.light[c], 2 * scene.objects[0].medium.color[c] * (1 - light.left), 1e-5);
    }
}

TEST(MediumLight, IsShadowedByWhatIsOpaqueAndLessSoByGlass) {
    Scene scene = blobScene(3, 0.1);
    scene.objects[0].medium.color = Vec3d(1.0);
    scene.lights = {lampFrom({1, 0, 0})};
    PictureOptions options;
    options.transport.shadows = true;
    const double lit = MediumScene(scene, options).along(kDown).light[0];
    EXPECT_GT(lit, 0.02);
    scene.objects.push_back(surfaceOf(ballAt(kBlobMiddle + Vec3d(45, 0, 0)), {}));
    EXPECT_LT(MediumScene(scene, options).along(kDown).light[0], 1e-3 * lit);
    options.transport.shadows = false;
    EXPECT_NEAR(MediumScene(scene, options).along(kDown).light[0], lit, 1e-9);
    options.transport.shadows = true;
    scene.objects[1].material.transparency = 1;
    const double dim = MediumScene(scene, options).along(kDown).light[0];
    EXPECT_LT(dim, 0.94 * lit);
    EXPECT_GT(dim, 0.8 * lit);
    // Beside the ball it is as before.
    scene.objects[1] = surfaceOf(ballAt(kBlobMiddle + Vec3d(45, 40, 0)), {});
    EXPECT_NEAR(MediumScene(scene, options).along(kDown).light[0], lit, 1e-9);
}

TEST(MediumLight, DimsTheSurfaceBehindIt) {
    Scene scene;
    const Vec3d behind(kBlobMiddle - Vec3d(0, 0, 50));
    Material white;
    white.color = Vec3d(1, 0.5, 0.25);
    scene.objects = {volumeOf(blobGrid(4), 0.15), surfaceOf(ballAt(behind), white)};
    scene.environment = furnace();
    const Image image = sceneToImage(scene, pictureFrom({0, 0, 1}, kBlobMiddle, 9, 18)).image;
    for (int column = 0; column < 9; ++column) {
        const Ray ray{kBlobMiddle + Vec3d(2.0 * (column - 4), 0, 60), Vec3d(0, 0, -1)};
        const double left = std::exp(-0.15 * throughBlob(*scene.objects[0].grid, 4, ray));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(colorAt(image, column, 4)[c], left * white.color[c], 1e-4);
        }
        EXPECT_EQ(image.color[4 * (4 * 9 + column) + 3], 1);
    }
}

TEST(MediumLight, DimsTheLampOfASurface) {
    // A blob between the lamp and a floor.
    const double middle = kBlobMiddle[2];
    Material white;
    white.color = Vec3d(1.0);
    Scene scene;
    scene.objects = {
        volumeOf(blobGrid(4), 0.15),
        surfaceOf(boxGrid(BBoxd(Vec3d(-30, -30, middle - 40), Vec3d(30, 30, middle - 30))), white)};
    scene.environment.color = Vec3d(0.0);
    scene.lights = {lampFrom({0, 0, 1})};
    const Vec3d foot(kBlobMiddle[0], kBlobMiddle[1], middle - 30);
    PictureOptions options = pictureFrom({1, 0, 1}, foot, 3, 0.3);
    options.camera.eye = foot + Vec3d(12, 0, 9);
    options.transport.shadows = true;
    const double left = std::exp(-0.15 * throughBlob(*scene.objects[0].grid, 4, kDown));
    EXPECT_NEAR(colorAt(sceneToImage(scene, options).image, 1, 1)[0], 0.8 * left, 1e-3);
}

TEST(MediumLight, OfHotBodiesIsThatOfTheirTemperature) {
    Scene scene = blobScene(4, 0.3);
    auto temperatures = openvdb::FloatGrid::create(2000);
    temperatures->fill({openvdb::Coord(-30), openvdb::Coord(30)}, 2000.0F, true);
    scene.objects[0].temperatures = temperatures;
    scene.objects[0].medium.glow = 2.5;
    const MediumLight light = MediumScene(scene, {}).along(kDown);
    const Vec3d& rgb = light.light;
    const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    EXPECT_NEAR(luminance / (1 - light.left), 2.5, 2.5e-2);
}

TEST(MediumLight, GathersFromAMapWhatIsThere) {
    // A map that is bright above only, and light that mostly goes onward: seen against the light
    // the volume is brighter than with it.
    PixelArray map{8, 4, 3, std::vector<float>(96, 0.0F)};
    std::fill_n(map.values.begin(), 24, 4.0F);
    Scene scene = blobScene(4, 0.02);
    scene.objects[0].medium.color = Vec3d(1.0);
    scene.objects[0].medium.anisotropy = 0.7;
    scene.environment.color = Vec3d(1.0);
    scene.environment.map = std::make_shared<const EnvironmentMap>(map, 0, "above");
    PictureOptions options;
    options.transport.gather = 1;
    MediumScene medium(scene, options);
    double up = 0, down = 0;
    for (int i = 0; i < 200; ++i) {
        up += medium.along({kBlobMiddle - Vec3d(0, 60, 0), Vec3d(0, 1, 0)}, i).light[0];
        down += medium.along({kBlobMiddle + Vec3d(0, 60, 0), Vec3d(0, -1, 0)}, i).light[0];
    }
    EXPECT_GT(up, 5 * down);
}

}  // namespace
}  // namespace bandvox

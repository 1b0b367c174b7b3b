// Cameras around a scene.

#include "render/scene_pieces.h"
#include "stop_after.h"

#include <bandvox/render/turntable.h>

#include <gtest/gtest.h>

namespace bandvox::render_test {
namespace {

Scene ballScene() {
    Scene scene;
    scene.objects.push_back(surfaceOf(ballGrid(), {}));
    return scene;
}

TEST(Turntable, TurnsAroundInEvenSteps) {
    PictureOptions options;
    options.camera.from = {0, 0, 1};
    const std::vector<CameraOptions> cameras = turntable(ballScene(), options, 4);
    ASSERT_EQ(cameras.size(), 4U);
    const openvdb::Vec3d middle = *cameras[0].lookat;
    for (int i = 0; i < 4; ++i) {
        const openvdb::Vec3d way = *cameras[i].eye - middle;
        const openvdb::Vec3d next = *cameras[(i + 1) % 4].eye - middle;
        EXPECT_NEAR(next.length(), way.length(), 1e-9);
        EXPECT_NEAR(way.dot(next), 0, 1e-9 * way.lengthSqr());
    }
}

TEST(Turntable, IsMadeUntilTheWorkIsToStop) {
    const Scene scene = ballScene();
    expectStopsMidway(20, [&](Progress& progress) { turntable(scene, {}, 50, progress); });
}

}  // namespace
}  // namespace bandvox::render_test

#include "render/screen_cells.h"

#include "render/ball_scene.h"
#include "render/ray_march.h"
#include "render/surface_object.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Coord;
using openvdb::Vec3d;

// A few balls here and there, with voxels that are turned and no cubes.
openvdb::FloatGrid::Ptr scattered(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    for (int ball = 0; ball < 4; ++ball) {
        const Vec3d middle(60 * uniform(random), 60 * uniform(random), 60 * uniform(random));
        const double radius = 2 + 4 * uniform(random);
        const Coord at = Coord::round(middle);
        const openvdb::CoordBBox box(at.offsetBy(-12), at.offsetBy(12));
        for (auto voxel = box.begin(); voxel; ++voxel) {
            const double density = ballDensity(((*voxel).asVec3d() - middle).length(), radius);
            if (density > 1e-4) accessor.setValue(*voxel, static_cast<float>(density));
        }
    }
    auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->postScale(Vec3d(0.5 + uniform(random), 0.7, 1));
    transform->postRotate(3 * uniform(random), openvdb::math::Y_AXIS);
    transform->postTranslate(Vec3d(10 * uniform(random), 0, -5));
    grid->setTransform(transform);
    return grid;
}

class EachView : public testing::TestWithParam<CameraOptions::Projection> {};

// The blocks that a line of sight through a pixel meets lie in its pixel's span.
TEST_P(EachView, LosesNothingThatIsSeen) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr int kWidth = 50, kHeight = 37;
    int hits = 0, empty = 0;
    for (int trial = 0; trial < 24; ++trial) {
        SceneObject object;
        object.grid = scattered(random);
        const SurfaceObject surface(object, {});
        const auto probe = surface.probe();
        const Vec3d middle = object.grid->indexToWorld(Vec3d(30));
        CameraOptions options;
        options.projection = GetParam();
        // From the middle of it, from near it, and from outside.
        const double away[] = {0.0, 15, 45, 300};
        options.eye =
            middle +
            away[trial % 4] *
                Vec3d(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5).unit();
        options.lookat = middle + 20 * Vec3d(uniform(random) - 0.5, uniform(random) - 0.5, 0.3);
        options.frame = 60 + 60 * uniform(random);
        options.aperture = trial % 3 == 0 ? 150 : 30;  // wide, and narrow
        const double margin = trial % 2 ? 1.5 : 0;
        const Camera camera(options, kWidth, kHeight, std::vector<Vec3d>{middle});
        const ScreenCells cells(camera, kWidth, kHeight, margin, surface.blocks(),
                                object.grid->transform());
        for (int row = 0; row < kHeight; ++row) {
            for (int column = 0; column < kWidth; ++column) {
                const auto& span = cells.span(column, row);
                if (span.empty()) ++empty;
                const double x = column - margin + (1 + 2 * margin) * uniform(random);
                const double y = row - margin + (1 + 2 * margin) * uniform(random);
                const Ray ray = camera.ray(x, y);
                // The blocks on its way, and in them the surface.
                const Vec3d origin = object.grid->worldToIndex(ray.origin);
                const Ray inGrid{origin,
                                 object.grid->worldToIndex(ray.origin + ray.direction) - origin};
                bool meets = false;
                surface.blocks().walk(inGrid, 1e9, [&](double t0, double t1) {
                    meets = true;
                    if (t1 - t0 < 1e-6) return false;  // touches it only
                    EXPECT_LE(span.near, t0) << trial << " " << column << " " << row;
                    EXPECT_GE(span.far, t1) << trial << " " << column << " " << row;
                    return false;
                });
                if (surface.entry(ray, 1e9, *probe)) {
                    ++hits;
                    EXPECT_TRUE(meets);
                }
                if (testing::Test::HasFailure()) return;
            }
        }
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(empty, 1000);
}

INSTANTIATE_TEST_SUITE_P(Views, EachView,
                         testing::Values(CameraOptions::Projection::Perspective,
                                         CameraOptions::Projection::Orthographic));

TEST(ScreenCells, AreEmptyBehindTheEye) {
    SceneObject object;
    object.grid = ballGrid();
    const SurfaceObject surface(object, {});
    CameraOptions options;
    options.eye = kCenter + Vec3d(0, 0, 100);
    options.lookat = kCenter + Vec3d(0, 0, 200);
    const Camera camera(options, 64, 64, std::vector<Vec3d>{kCenter});
    const ScreenCells cells(camera, 64, 64, 0, surface.blocks(), object.grid->transform());
    for (int row = 0; row < 64; ++row) EXPECT_TRUE(cells.span(row, row).empty());
}

}  // namespace
}  // namespace bandvox

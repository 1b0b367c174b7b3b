// Pictures of grids that this library has not made: level sets, fog, voxels of any shape.

#include "render/ball_scene.h"

#include <bandvox/core/error.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/render/density_to_image.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <functional>
#include <limits>

namespace bandvox::render_test {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

// A narrow band of distances from a ball, world units, on a lattice with the given transform.
openvdb::FloatGrid::Ptr ballLevelSet(const openvdb::math::Transform::Ptr& transform,
                                     const Vec3d& center, double radius, double band) {
    auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
    grid->setTransform(transform);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("surface");
    auto accessor = grid->getAccessor();
    openvdb::CoordBBox box;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        box.expand(Coord::round(transform->worldToIndex(center + (radius + band) * corner)));
    }
    box.expand(1);
    for (auto voxel = box.begin(); voxel; ++voxel) {
        const double distance =
            (transform->indexToWorld((*voxel).asVec3d()) - center).length() - radius;
        if (std::abs(distance) < band) {
            accessor.setValue(*voxel, static_cast<float>(distance));
        } else if (distance < 0) {
            accessor.setValueOff(*voxel, static_cast<float>(-band));
        }
    }
    return grid;
}

// Where and how a ball of `radius` at `center` is seen: in the right place, facing the right way.
void expectBall(const Image& image, const Vec3d& center, double radius, double placeError,
                double cosine) {
    int hits = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        if (!std::isfinite(image.depth[i])) continue;
        ++hits;
        const Vec3d fromCenter = positionAt(image, i) - center;
        EXPECT_NEAR(fromCenter.length(), radius, placeError);
        EXPECT_GT(normalAt(image, i).dot(fromCenter.unit()), cosine);
    }
    EXPECT_GT(hits, 300);
}

TEST(ForeignGrids, LevelSetsAreDrawn) {
    const Vec3d center(0.21, -0.13, 0.05);
    const auto grid =
        ballLevelSet(openvdb::math::Transform::createLinearTransform(0.05), center, 1, 0.15);
    expectBall(densityToImage(grid, smallPicture()).image, center, 1, 1e-3, 0.9999);
    // The grid is left as it was.
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_FLOAT_EQ(grid->background(), 0.15F);

    RenderOptions options = smallPicture();
    options.iso = 0.06;  // further out
    expectBall(densityToImage(grid, options).image, center, 1.06, 1e-3, 0.999);
    options.iso = 0.2;  // beyond the band
    EXPECT_THROW(densityToImage(grid, options), Error);
    options.iso.reset();
    for (const Shading shading : {Shading::Phong, Shading::Sobel3d}) {
        options.shading = shading;
        EXPECT_GT(densityToImage(grid, options).hits, 500);
    }
}

TEST(ForeignGrids, VoxelsMayBeOfAnyShapeAndTurned) {
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    matrix.preScale(Vec3d(0.04, 0.07, 0.11));
    matrix.preRotate(openvdb::math::X_AXIS, 0.5);
    matrix.preRotate(openvdb::math::Z_AXIS, -0.8);
    matrix.preTranslate(Vec3d(3, -2, 1));
    const auto transform = openvdb::math::Transform::createLinearTransform(matrix);
    const Vec3d center(3.3, -2.2, 1.1);
    const auto grid = ballLevelSet(transform, center, 1, 0.35);
    expectBall(densityToImage(grid, smallPicture()).image, center, 1, 2e-3, 0.9998);
}

// Lines of sight that graze a sheet of one voxel, against a march in steps of a fiftieth of one.
TEST(ForeignGrids, ThinSheetsAreNotMissed) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    for (int x = -20; x <= 20; ++x) {
        for (int y = -20; y <= 20; ++y) accessor.setValue(Coord(x, y, 3), 1.0F);
    }
    const auto reconstruction = makeSplineReconstruction(grid);
    const auto spline = reconstruction->probe();
    for (const double slope : {0.3, 0.05, 0.01}) {
        RenderOptions options;
        options.width = 40;
        options.height = 40;
        options.camera.projection = CameraOptions::Projection::Orthographic;
        options.camera.eye = Vec3d(60, 7, 3.1 + 60 * slope);
        options.camera.lookat = Vec3d(0, 0, 3.1);
        options.camera.up = Vec3d(0, 0, 1);
        options.camera.frame = 4 + 60 * slope;
        const Image image = densityToImage(grid, options).image;
        const Camera camera(options.camera, 40, 40, {Vec3d(-20.0), Vec3d(20.0)});
        int different = 0, hits = 0;
        for (int row = 0; row < 40; ++row) {
            for (int column = 0; column < 40; column += 7) {
                const Ray ray = camera.ray(column + 0.5, row + 0.5);
                bool isHit = false;
                for (double t = 20; t < 100 && !isHit; t += 0.02) {
                    isHit = spline->value(ray.origin + t * ray.direction) >= 0.5;
                }
                const bool isSeen =
                    std::isfinite(image.depth[static_cast<std::size_t>(row) * 40 + column]);
                hits += isHit ? 1 : 0;
                different += isSeen == isHit ? 0 : 1;
            }
        }
        EXPECT_GT(hits, 10) << slope;
        EXPECT_EQ(different, 0) << slope;
    }
}

TEST(ForeignGrids, FogOfTilesAloneIsDrawn) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(1, Coord(0), 3.0F, true);
    RenderOptions options = smallPicture(40, 30);
    options.iso = 1.5;
    EXPECT_GT(densityToImage(grid, options).hits, 100);
    options.iso = 7;  // what a spline overshoots by does not reach that
    EXPECT_THROW(densityToImage(grid, options), Error);
}

TEST(ForeignGrids, NothingMayBeSeenIfThatIsAllowed) {
    RenderOptions options = smallPicture(20, 15);
    options.background = Vec3d(0.25, 0.5, 1);
    auto thin = openvdb::FloatGrid::create(0);
    thin->fill(openvdb::CoordBBox(Coord(0), Coord(20)), 0.2F);
    auto behind = ballGrid();
    for (const Shading shading : {Shading::Spectral, Shading::Phong}) {
        options.shading = shading;
        for (const auto& grid : {openvdb::FloatGrid::create(0), thin, behind}) {
            if (grid == behind) {
                options.camera.eye = Vec3d(20, 20, 500);
                options.camera.lookat = Vec3d(20, 20, 1000);
            }
            options.allowEmpty = false;
            EXPECT_THROW(densityToImage(grid, options), Error);
            options.allowEmpty = true;
            const RenderResult result = densityToImage(grid, options);
            EXPECT_EQ(result.hits, 0);
            EXPECT_EQ(result.rays, 300);
            for (std::size_t i = 0; i < 300; ++i) {
                EXPECT_EQ(result.image.color[4 * i + 1], 0.5F);
                EXPECT_EQ(result.image.color[4 * i + 3], 1);
                EXPECT_TRUE(std::isinf(result.image.depth[i]));
            }
        }
        options.camera = {};
    }
}

}  // namespace
}  // namespace bandvox::render_test

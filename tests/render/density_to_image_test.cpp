#include "render/ball_scene.h"

#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/density_to_image.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

class EachProjection : public testing::TestWithParam<CameraOptions::Projection> {};

TEST_P(EachProjection, DrawsABallWhereItIs) {
    // Voxels of another size than 1, turned and shifted, so that each space matters.
    auto grid = ballGrid();
    auto transform = openvdb::math::Transform::createLinearTransform(0.05);
    transform->postRotate(0.4, openvdb::math::X_AXIS);
    transform->postTranslate(Vec3d(3, -2, 7));
    grid->setTransform(transform);
    RenderOptions options = smallPicture();
    options.camera.projection = GetParam();
    const RenderResult result = densityToImage(grid, options);
    const Image& image = result.image;

    const double surface = 0.05 * ballSurface(kRadius, 0.5);
    const Vec3d center = grid->indexToWorld(kCenter);
    std::size_t seen = 0, front = 0;
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        if (std::isinf(image.depth[pixel])) {
            EXPECT_EQ(image.color[4 * pixel + 3], 0);
            EXPECT_EQ(normalAt(image, pixel), Vec3d(0.0));
            continue;
        }
        ++seen;
        EXPECT_EQ(image.color[4 * pixel + 3], 1);
        const Vec3d offset = positionAt(image, pixel) - center;
        const Vec3d normal = normalAt(image, pixel);
        EXPECT_NEAR(offset.length(), surface, 0.05 * 3e-4);
        EXPECT_NEAR(normal.length(), 1, 1e-6);
        const double angle = std::asin(std::min(1.0, offset.unit().cross(normal).length()));
        EXPECT_LT(angle, 0.1 * kDegree);
        EXPECT_GT(offset.dot(normal), 0);
        if (angle < 0.02 * kDegree) ++front;
    }
    EXPECT_EQ(result.hits, static_cast<std::int64_t>(seen));
    EXPECT_EQ(result.rays, 120 * 90);
    EXPECT_GT(front, seen / 2);
}

INSTANTIATE_TEST_SUITE_P(Projections, EachProjection,
                         testing::Values(CameraOptions::Projection::Perspective,
                                         CameraOptions::Projection::Orthographic));
TEST(DensityToImage, GivesDepthAlongTheView) {
    const RenderResult result = densityToImage(ballGrid(), frontView(90, 45));
    const double surface = ballSurface(kRadius, 0.5);
    for (int row = 0; row < 90; ++row) {
        for (int column = 0; column < 90; ++column) {
            const double x = 0.5 * (column + 0.5) - 22.5, y = 22.5 - 0.5 * (row + 0.5);
            const double squared = surface * surface - x * x - y * y;
            const float depth = result.image.depth[row * 90 + column];
            // Away from the rim, where an error of the surface grows.
            if (squared > 4) {
                EXPECT_NEAR(depth, 60 - std::sqrt(squared), 2e-3);
            }
            if (squared < -0.1) {
                EXPECT_TRUE(std::isinf(depth));
            }
        }
    }
}

TEST(DensityToImage, CoversTheSilhouette) {
    RenderOptions options = frontView(64, 45);
    options.samples = 16;
    const RenderResult result = densityToImage(ballGrid(), options);
    double area = 0;
    for (std::size_t pixel = 0; pixel < 64 * 64; ++pixel) {
        area += result.image.color[4 * pixel + 3];
    }
    area *= 45.0 / 64 * 45 / 64;
    const double surface = ballSurface(kRadius, 0.5);
    EXPECT_NEAR(area, kPi * surface * surface, 0.003 * area);
    EXPECT_EQ(result.rays, 64 * 64 * 16);
}

TEST(DensityToImage, FollowsIso) {
    for (const double iso : {0.02, 0.3, 0.9}) {
        RenderOptions options = frontView(9, 10);
        options.iso = iso;
        const RenderResult result = densityToImage(ballGrid(), options);
        EXPECT_NEAR(result.image.depth[4 * 9 + 4], 60 - ballSurface(kRadius, iso), 3e-3) << iso;
    }
}

TEST(DensityToImage, ShadesByLambert) {
    RenderOptions options = frontView(5, 1);
    options.light = Vec3d(0, std::sqrt(3.0), 1);  // 60° above the view
    options.color = Vec3d(1, 0.5, 0.25);
    options.ambient = 0.2;
    const RenderResult result = densityToImage(ballGrid(), options);
    const float* middle = &result.image.color[4 * 12];
    EXPECT_NEAR(middle[0], 0.6, 2e-3);  // 0.2 + 0.8 / 2
    EXPECT_NEAR(middle[1], 0.3, 2e-3);
    EXPECT_NEAR(middle[2], 0.15, 2e-3);
}

TEST(DensityToImage, FillsTheBackground) {
    RenderOptions options = frontView(32, 60);
    options.background = Vec3d(0.1, 0.2, 0.3);
    const Image image = densityToImage(ballGrid(), options).image;
    EXPECT_FLOAT_EQ(image.color[0], 0.1F);
    EXPECT_FLOAT_EQ(image.color[2], 0.3F);
    for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
        EXPECT_EQ(image.color[4 * pixel + 3], 1);
    }
}

TEST(DensityToImage, AnyNumberOfSamplesCoversThePixelEvenly) {
    for (const int samples : {1, 2, 3, 5, 7, 12}) {
        RenderOptions options = frontView(8, 45);
        options.samples = samples;
        const RenderResult result = densityToImage(ballGrid(), options);
        EXPECT_EQ(result.rays, 64 * samples);
        double left = 0, right = 0, alpha = 0;
        for (int pixel = 0; pixel < 64; ++pixel) {
            const double a = result.image.color[4 * pixel + 3];
            (pixel % 8 < 4 ? left : right) += a;
            alpha += a;
        }
        EXPECT_NEAR(left, right, 1e-5) << samples;  // the ball is in the middle
        EXPECT_NEAR(alpha * samples, static_cast<double>(result.hits), 1e-3);
    }
}

TEST(DensityToImage, IsTheSameForAnyNumberOfThreads) {
    const auto grid = ballGrid();
    RenderOptions options = smallPicture(100, 70);
    options.samples = 2;
    const auto draw = [&](int threads) {
        const ThreadLimit limit(threads);
        return densityToImage(grid, options);
    };
    const RenderResult one = draw(1);
    for (const int threads : {2, 4}) {
        const RenderResult many = draw(threads);
        EXPECT_EQ(one.hits, many.hits);
        EXPECT_EQ(one.image.color, many.image.color);
        EXPECT_EQ(one.image.depth, many.image.depth);
        EXPECT_EQ(one.image.normal, many.image.normal);
        EXPECT_EQ(one.image.position, many.image.position);
    }
}

TEST(DensityToImage, AThinSheetAtAGrazingAngleHasNoHoles) {
    // One voxel thick, tilted, its middle wandering between the nodes of the lattice.
    const ExponentialFilter filter{8, 0.35};
    const Vec3d up = Vec3d(0.03, 1, 0.05).unit();
    const auto sheet = [&](const Vec3d& x) {
        const double r = x.dot(up);
        return halfSpaceDensity(filter, r - 0.5) - halfSpaceDensity(filter, r + 0.5);
    };
    const auto grid =
        makeGrid(openvdb::CoordBBox(Coord(-28, -9, -28), Coord(28, 9, 28)), filter, sheet);
    const double top = sheet(Vec3d(0.0));
    RenderOptions options = smallPicture(160, 40);
    options.iso = 0.9 * top;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.lookat = Vec3d(0.0);
    options.camera.eye = Vec3d(2, 6, 60);  // 6° above
    options.camera.frame = 28;
    const Image image = densityToImage(grid, options).image;
    // The middle of the picture, all within the sheet.
    int holes = 0;
    for (int row = 16; row < 24; ++row) {
        for (int column = 0; column < 160; ++column) {
            holes += std::isinf(image.depth[row * 160 + column]) ? 1 : 0;
        }
    }
    EXPECT_EQ(holes, 0);
}

TEST(DensityToImage, AnEyeInsideSeesTheDensityAtItself) {
    RenderOptions options = smallPicture(16, 16);
    options.camera.eye = kCenter;
    options.camera.lookat = kCenter + Vec3d(0, 0, -1);
    const RenderResult result = densityToImage(ballGrid(), options);
    EXPECT_EQ(result.hits, 16 * 16);
    for (std::size_t pixel = 0; pixel < 256; ++pixel) {
        EXPECT_EQ(result.image.depth[pixel], 0);
        EXPECT_NEAR(normalAt(result.image, pixel).length(), 1, 1e-6);
        EXPECT_GT(normalAt(result.image, pixel)[2], 0) << "the surface faces the eye";
    }
}

TEST(DensityToImage, SeesTheFarWallFromACavity) {
    // A shell: dense between two radii, the eye in its hollow.
    const auto grid = makeGrid(openvdb::CoordBBox(Coord(-30), Coord(30)), {}, [](const Vec3d& x) {
        return ballDensity(x.length(), 22) - ballDensity(x.length(), 12);
    });
    RenderOptions options = smallPicture(32, 32);
    options.camera.eye = Vec3d(1, 0, 0);
    options.camera.lookat = Vec3d(5, 0, 0);
    const RenderResult result = densityToImage(grid, options);
    EXPECT_EQ(result.hits, 32 * 32);
    for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
        const Vec3d position = positionAt(result.image, pixel);
        EXPECT_NEAR(position.length(), ballSurface(12, 0.5), 0.01);
        EXPECT_LT(normalAt(result.image, pixel).dot(position), 0);
    }
}

TEST(DensityToImage, DrawsVoxelsThatAreNotCubes) {
    auto grid = ballGrid();
    grid->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(
        openvdb::math::MapBase::Ptr(new openvdb::math::ScaleMap(Vec3d(1, 2, 0.5))))));
    const Image image = densityToImage(grid, smallPicture()).image;
    const double surface = ballSurface(kRadius, 0.5);
    std::size_t seen = 0;
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        if (std::isinf(image.depth[pixel])) continue;
        ++seen;
        const Vec3d offset = grid->worldToIndex(positionAt(image, pixel)) - kCenter;
        EXPECT_NEAR(offset.length(), surface, 1e-3);
        const Vec3d normal = Vec3d(offset[0], offset[1] / 2, offset[2] * 2).unit();
        EXPECT_LT(normal.cross(normalAt(image, pixel)).length(), 0.1 * kDegree);
    }
    EXPECT_GT(seen, 1000u);
}
TEST(DensityToImage, DrawsSharpFiltersAsWellAsCanBe) {
    // Read as if filtered sharply: the reconstruction cannot reach the finest tolerance.
    auto grid = ballGrid();
    DensityMetadata metadata = *densityMetadata(*grid);
    metadata.order = 16;
    metadata.cutoff = 0.42;
    setDensityMetadata(*grid, metadata);
    const RenderResult result = densityToImage(grid, frontView(9, 10));
    EXPECT_NEAR(result.image.depth[4 * 9 + 4], 60 - ballSurface(kRadius, 0.5), 1e-2);
}

}  // namespace
}  // namespace bandvox

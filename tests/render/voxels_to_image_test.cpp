#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/density_to_image.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using bandvox::CameraOptions;
using bandvox::densityToImage;
using bandvox::Error;
using bandvox::ErrorKind;
using bandvox::Image;
using bandvox::RenderOptions;
using bandvox::RenderResult;
using bandvox::Shading;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

constexpr double kDegree = std::numbers::pi / 180;
const std::vector<Shading> kOlder{Shading::Depth, Shading::Phong, Shading::Cross, Shading::Sobel2d,
                                  Shading::Sobel3d};
const std::vector<Shading> kWithNormals(kOlder.begin() + 1, kOlder.end());

openvdb::FloatGrid::Ptr binaryGrid(const CoordBBox& box,
                                   const std::function<bool(const Vec3d&)>& inside) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    for (auto voxel = box.begin(); voxel; ++voxel) {
        if (inside((*voxel).asVec3d())) accessor.setValue(*voxel, 1);
    }
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

// 64³ voxels around the middle of eight of them, one pixel each.
const Vec3d kCenter(-0.5);
constexpr double kRadius = 31;

openvdb::FloatGrid::Ptr ballGrid() {
    return binaryGrid(CoordBBox(Coord(-32), Coord(31)),
                      [](const Vec3d& x) { return (x - kCenter).length() <= kRadius; });
}

RenderOptions pixelPerVoxel(Shading shading, int side = 64) {
    RenderOptions options;
    options.width = options.height = side;
    options.shading = shading;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.eye = kCenter + Vec3d(0, 0, 100);
    options.camera.lookat = kCenter;
    options.camera.frame = side;
    return options;
}

Vec3d normalAt(const Image& image, std::size_t pixel) {
    return {image.normal[3 * pixel], image.normal[3 * pixel + 1], image.normal[3 * pixel + 2]};
}

bool isSeen(const Image& image, std::size_t pixel) {
    return !std::isinf(image.depth[pixel]);
}

/// Angles between the normals of a picture of the ball and its true ones, degrees.
std::vector<double> ballErrors(const Image& image) {
    std::vector<double> errors;
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        if (!isSeen(image, pixel)) continue;
        const double x = static_cast<double>(pixel % 64) - 31.5;
        const double y = 31.5 - static_cast<double>(pixel / 64);
        const Vec3d truth(x, y, std::sqrt(kRadius * kRadius - x * x - y * y));
        const double cosine = truth.dot(normalAt(image, pixel)) / kRadius;
        errors.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree);
    }
    return errors;
}

TEST(VoxelsToImage, MeanErrorsOnABallAreThoseOfStripes) {
    const auto grid = ballGrid();
    std::map<Shading, double> mean;
    for (const Shading shading : kWithNormals) {
        const std::vector<double> errors =
            ballErrors(densityToImage(grid, pixelPerVoxel(shading)).image);
        EXPECT_GT(errors.size(), 2900U);
        for (const double error : errors) mean[shading] += error / double(errors.size());
    }
    for (const Shading sobel : {Shading::Sobel2d, Shading::Sobel3d}) {
        EXPECT_GT(mean[sobel], 4) << static_cast<int>(sobel);
        EXPECT_LT(mean[sobel], 9) << static_cast<int>(sobel);
    }
    // A smaller neighbourhood is worse.
    EXPECT_GT(mean[Shading::Cross], mean[Shading::Sobel2d]);
    EXPECT_GT(mean[Shading::Phong], mean[Shading::Sobel3d]);
    EXPECT_LT(mean[Shading::Cross], 15);
    EXPECT_LT(mean[Shading::Phong], 15);
}

TEST(VoxelsToImage, AFaceOfABlockIsExact) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->fill(CoordBBox(Coord(-20, -24, -28), Coord(20, 24, 28)), 1);
    auto transform = openvdb::math::Transform::createLinearTransform(0.1);
    transform->preScale(Vec3d(1, 2, 0.5));
    transform->postRotate(0.3, openvdb::math::Z_AXIS);
    transform->postTranslate(Vec3d(4, 5, -6));
    grid->setTransform(transform);
    const Coord half(20, 24, 28);
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, side = face % 2 == 0 ? -1 : 1;
        Vec3d middle(0.0), covector(0.0);
        middle[axis] = side * (half[axis] + 0.5);
        covector[axis] = side;
        const Vec3d place = grid->indexToWorld(middle);
        const Vec3d normal = grid->transform().baseMap()->applyIJT(covector).unit();
        for (const Shading shading : kWithNormals) {
            // A slanted look at the middle of the face, in perspective.
            RenderOptions options;
            options.width = options.height = 24;
            options.shading = shading;
            options.camera.lookat = place;
            options.camera.eye = place + 3 * normal + Vec3d(0.7, 0.4, 0.5);
            options.camera.up = Vec3d(0.2, 0.5, 1);
            options.camera.focal = 300;
            const Image image = densityToImage(grid, options).image;
            for (std::size_t pixel = 0; pixel < 24 * 24; ++pixel) {
                ASSERT_TRUE(isSeen(image, pixel));
                EXPECT_LT((normalAt(image, pixel) - normal).length(), 1e-6)
                    << face << ' ' << static_cast<int>(shading);
                const Vec3d position(image.position[3 * pixel], image.position[3 * pixel + 1],
                                     image.position[3 * pixel + 2]);
                EXPECT_NEAR((position - place).dot(normal), 0, 1e-5);
            }
        }
    }
}

TEST(VoxelsToImage, GivesTheDepthOfTheFirstVoxel) {
    const auto grid = ballGrid();
    for (const Shading shading : kOlder) {
        const RenderResult result = densityToImage(grid, pixelPerVoxel(shading));
        std::int64_t hits = 0;
        for (int row = 0; row < 64; ++row) {
            for (int column = 0; column < 64; ++column) {
                int z = 31;
                while (z >= -32 && grid->tree().getValue(Coord(column - 32, 31 - row, z)) == 0) --z;
                const float depth = result.image.depth[row * 64 + column];
                if (z < -32) {
                    EXPECT_TRUE(std::isinf(depth));
                    continue;
                }
                ++hits;
                EXPECT_NEAR(depth, 99.5 - (z + 0.5), 1e-5);
            }
        }
        EXPECT_EQ(result.hits, hits);
        EXPECT_EQ(result.rays, 64 * 64);
    }
}

TEST(VoxelsToImage, DepthAloneIsBrightWhereNear) {
    RenderOptions options = pixelPerVoxel(Shading::Depth);
    options.ambient = 0;
    options.color = Vec3d(1.0);
    const Image image = densityToImage(ballGrid(), options).image;
    std::vector<std::pair<float, float>> tones;  // depth, brightness
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        EXPECT_EQ(normalAt(image, pixel), Vec3d(0.0));
        if (isSeen(image, pixel)) tones.emplace_back(image.depth[pixel], image.color[4 * pixel]);
    }
    std::sort(tones.begin(), tones.end());
    for (std::size_t i = 1; i < tones.size(); ++i) {
        if (tones[i].first > tones[i - 1].first) {
            EXPECT_LT(tones[i].second, tones[i - 1].second);
        } else {
            EXPECT_EQ(tones[i].second, tones[i - 1].second);
        }
    }
    // The ball's nearest voxels touch its box; only its front half is seen.
    EXPECT_NEAR(tones.front().second, 1, 1e-6);
    EXPECT_NEAR(tones.back().second, 0.5, 0.12);
}

TEST(VoxelsToImage, ASymmetricBallHasASymmetricPicture) {
    for (const Shading shading : kOlder) {
        RenderOptions options = pixelPerVoxel(shading);
        options.light = Vec3d(0, 0, 1);
        const Image image = densityToImage(ballGrid(), options).image;
        const auto color = [&](int row, int column) {
            return image.color[4 * (64 * row + column)];
        };
        for (int row = 0; row < 64; ++row) {
            for (int column = 0; column < 64; ++column) {
                EXPECT_NEAR(color(row, column), color(row, 63 - column), 1e-6);
                EXPECT_NEAR(color(row, column), color(63 - row, column), 1e-6);
                EXPECT_NEAR(color(row, column), color(column, row), 1e-6);
            }
        }
    }
}

TEST(VoxelsToImage, NormalsAreUnitAndFaceTheEyeEvenAtTheRim) {
    const auto grid = ballGrid();
    for (const Shading shading : {Shading::Cross, Shading::Sobel2d}) {
        RenderOptions options;
        options.width = 90;
        options.height = 70;
        options.shading = shading;
        const Image image = densityToImage(grid, options).image;
        const bandvox::Camera camera(options.camera, 90, 70,
                                     openvdb::BBoxd(Vec3d(-31.5), Vec3d(30.5)));
        for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
            if (!isSeen(image, pixel)) continue;
            const Vec3d normal = normalAt(image, pixel);
            EXPECT_NEAR(normal.length(), 1, 1e-6);
            const bandvox::Ray ray = camera.ray(static_cast<double>(pixel % 90) + 0.5,
                                                static_cast<double>(pixel / 90) + 0.5);
            EXPECT_LT(normal.dot(ray.direction), 0);
        }
    }
}

TEST(VoxelsToImage, ALonelyVoxelIsSeenByAll) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().setValue(Coord(-1), 1);
    for (const Shading shading : kWithNormals) {
        // One pixel sees it, and there is no neighbour to compare with.
        const RenderResult result = densityToImage(grid, pixelPerVoxel(shading, 8));
        EXPECT_EQ(result.hits, 1);
        EXPECT_EQ(normalAt(result.image, 4 * 8 + 3), Vec3d(0, 0, 1)) << static_cast<int>(shading);
    }
}

TEST(VoxelsToImage, ADensityIsDrawnAsItsVoxels) {
    const auto dense = [](const Vec3d& x) { return 1.2 - (x - kCenter).length() / 40; };
    auto density = openvdb::FloatGrid::create(0);
    for (auto voxel = CoordBBox(Coord(-40), Coord(40)).begin(); voxel; ++voxel) {
        const double value = dense((*voxel).asVec3d());
        if (value > 0) density->tree().setValue(*voxel, static_cast<float>(value));
    }
    const auto binary = binaryGrid(CoordBBox(Coord(-40), Coord(40)), [&](const Vec3d& x) {
        return static_cast<float>(dense(x)) >= 0.6F;
    });
    for (const Shading shading : kWithNormals) {
        RenderOptions options = pixelPerVoxel(shading);
        options.iso = 0.6;
        const Image a = densityToImage(density, options).image;
        const Image b = densityToImage(binary, options).image;
        EXPECT_EQ(a.color, b.color);
        EXPECT_EQ(a.normal, b.normal);
        EXPECT_EQ(a.depth, b.depth);
    }
}

TEST(VoxelsToImage, SamplesCoverTheRimAndTheBackground) {
    RenderOptions options = pixelPerVoxel(Shading::Phong, 16);
    options.camera.frame = 64;
    options.samples = 16;
    options.background = Vec3d(0.25, 0.5, 1);
    const RenderResult result = densityToImage(ballGrid(), options);
    EXPECT_EQ(result.rays, 16 * 16 * 16);
    EXPECT_NEAR(static_cast<double>(result.hits), std::numbers::pi * kRadius * kRadius, 40);
    EXPECT_EQ(result.image.color[2], 1);
    EXPECT_EQ(result.image.color[3], 1);
}

TEST(VoxelsToImage, IsTheSameForAnyNumberOfThreads) {
    const auto grid = ballGrid();
    for (const Shading shading : kOlder) {
        RenderOptions options;
        options.width = 75;
        options.height = 50;
        options.samples = 3;
        options.shading = shading;
        const auto draw = [&](int threads) {
            const bandvox::ThreadLimit limit(threads);
            return densityToImage(grid, options);
        };
        const RenderResult one = draw(1), two = draw(2);
        EXPECT_EQ(one.hits, two.hits);
        EXPECT_EQ(one.image.color, two.image.color);
        EXPECT_EQ(one.image.depth, two.image.depth);
        EXPECT_EQ(one.image.normal, two.image.normal);
        EXPECT_EQ(one.image.position, two.image.position);
    }
}

TEST(VoxelsToImage, AnEyeInsideSeesTheSurfaceAtItself) {
    for (const Shading shading : kOlder) {
        RenderOptions options = pixelPerVoxel(shading, 8);
        options.camera.eye = kCenter + Vec3d(0.1, 0.2, 0.3);
        const RenderResult result = densityToImage(ballGrid(), options);
        EXPECT_EQ(result.hits, 64);
        EXPECT_NEAR(result.image.depth[0], 0, 1e-12);
    }
}

TEST(VoxelsToImage, RefusesAsTheOthersDo) {
    const auto kindOfFailure = [](const openvdb::FloatGrid::Ptr& grid,
                                  const RenderOptions& options) {
        try {
            densityToImage(grid, options);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << "a picture came";
        return ErrorKind::Runtime;
    };
    for (const Shading shading : kOlder) {
        RenderOptions options = pixelPerVoxel(shading, 8);
        options.iso = 2;
        EXPECT_EQ(kindOfFailure(ballGrid(), options), ErrorKind::Result);
        options.iso = 0;
        EXPECT_EQ(kindOfFailure(ballGrid(), options), ErrorKind::Usage);
        options.iso = 0.5;
        options.camera.lookat = Vec3d(0, 0, 300);
        EXPECT_EQ(kindOfFailure(ballGrid(), options), ErrorKind::Result);
    }
}

TEST(VoxelsToImage, APictureOfVoxelsNamesTheirSource) {
    const auto grid = ballGrid();
    bandvox::setVoxelMetadata(*grid, "ball.obj");
    const std::pair<std::string, std::string> source{"bandvox_source", "ball.obj"};
    for (const Shading shading : {Shading::Spectral, Shading::Phong}) {
        const auto metadata = densityToImage(grid, pixelPerVoxel(shading)).image.metadata;
        EXPECT_EQ(std::count_if(metadata.begin(), metadata.end(),
                                [&](const auto& entry) {
                                    const auto* text = std::get_if<std::string>(&entry.second);
                                    return entry.first == source.first && text &&
                                           *text == source.second;
                                }),
                  1);
    }
}

TEST(VoxelsToImage, EveryShadingHasAName) {
    EXPECT_EQ(bandvox::shadingNames().size(), kOlder.size() + 1);
    EXPECT_EQ(bandvox::shadingNames()[static_cast<int>(Shading::Sobel3d)], "sobel3d");
}

}  // namespace

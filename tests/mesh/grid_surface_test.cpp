#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/grid_surface.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;

FloatGrid::Ptr ballLevelSet(double radius, const Vec3d& center, double voxel) {
    return openvdb::tools::createLevelSetSphere<FloatGrid>(
        static_cast<float>(radius), openvdb::Vec3f(center), static_cast<float>(voxel));
}

// Values that cross in every way there is, nothing of which reaches the border.
FloatGrid::Ptr noise(int side, unsigned seed) {
    auto grid = FloatGrid::create(0.0F);
    std::minstd_rand random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    auto accessor = grid->getAccessor();
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) accessor.setValue({x - 5, y - 3, z - 9}, value(random));
        }
    }
    return grid;
}

double ballVolume(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

TEST(GridSurface, OfABallIsTheBallButForChords) {
    for (const double voxel : {0.1, 0.05, 0.025}) {
        const auto grid = ballLevelSet(1, {0.3, -7.2, 40}, voxel);
        const auto source = makeGridSurface("ball", grid);
        // Chords lie inside by up to an eighth of κ h², twice for two curvatures.
        const double inset = voxel * voxel / 4;
        EXPECT_LT(source->volume(), ballVolume(1));
        EXPECT_GT(source->volume(), ballVolume(1 - inset));
        EXPECT_NEAR(source->area(), 4 * std::numbers::pi, 8 * std::numbers::pi * inset);
        const openvdb::BBoxd box = source->bounds();
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(box.extents()[axis], 2, 2 * inset);
        EXPECT_EQ(source->name(), "ball");
    }
}

TEST(GridSurface, BecomesNearlyTheDensityOfTheBallItself) {
    const auto ball = makeShapeBoundary("shape:sphere");
    const double radius = ball->bounds().extents()[0] / 2;
    const double fine = radius / 50;
    DensityOptions options;
    options.voxelSize = 2 * fine;
    options.tolerance = 1e-5;
    const auto source = makeGridSurface("ball", ballLevelSet(radius, {0, 0, 0}, fine));
    const DensityResult result = surfaceToDensity(*source, options);
    EXPECT_LE(result.metadata.closureError, 1e-5);
    EXPECT_NEAR(result.metadata.gridVolume, source->volume(), 1e-4 * source->volume());

    // The surface is off by up to κ h² / 4, and the density by 0.29 for each voxel of that.
    const DensityResult exact = surfaceToDensity(*ball, options);
    const double allowed = 0.29 * fine * fine / radius / 4 / options.voxelSize + 1e-5;
    const auto accessor = result.grid->getConstAccessor();
    double worst = 0;
    for (auto value = exact.grid->cbeginValueOn(); value; ++value) {
        worst = std::max(worst, std::abs(double(*value) - accessor.getValue(value.getCoord())));
    }
    EXPECT_LT(worst, allowed);
    EXPECT_GT(worst, 0.1 * allowed) << "the surface is that of chords";
}

TEST(GridSurface, OfNoiseIsClosed) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const auto grid = noise(21, seed);
        for (const double iso : {0.3, 0.5, 0.8}) {
            const auto source = makeGridSurface("noise", grid, {iso, openvdb::Mat4d::identity()});
            for (const double voxel : {0.9, 1.7}) {
                DensityOptions options;
                options.voxelSize = voxel;
                options.tolerance = 1e-4;
                const DensityResult result = surfaceToDensity(*source, options);
                EXPECT_LE(result.metadata.closureError, 1e-4);
                EXPECT_NEAR(result.metadata.gridVolume, source->volume(), 1e-3 * source->volume());
            }
        }
    }
}

TEST(GridSurface, EnclosesWhatTheMeshOfTheSameCellsDoes) {
    // On a plane field cells have no curvature, so spline and linear reading agree.
    auto grid = FloatGrid::create(-40.0F);
    auto accessor = grid->getAccessor();
    for (int x = -12; x <= 12; ++x) {
        for (int y = -12; y <= 12; ++y) {
            for (int z = -12; z <= 12; ++z) {
                accessor.setValue(
                    {x, y, z}, static_cast<float>(8.2 - std::abs(x) - std::abs(y) - std::abs(z)));
            }
        }
    }
    const auto source = makeGridSurface("octahedron", grid, {0.0, openvdb::Mat4d::identity()});
    EXPECT_NEAR(source->volume(), 4.0 / 3.0 * 8.2 * 8.2 * 8.2, 3);
}

TEST(GridSurface, FollowsAnyTransform) {
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    matrix.setToRotation(Vec3d(1, 2, 3).unit(), 0.7);
    matrix.preScale(Vec3d(0.5, 0.25, 1.5));
    matrix.postTranslate(Vec3d(100, -20, 7));
    const auto plain = noise(15, 9);
    const double volume = makeGridSurface("noise", plain)->volume();
    for (const double mirror : {1.0, -1.0}) {
        openvdb::Mat4d turned = matrix;
        turned.preScale(Vec3d(mirror, 1, 1));
        const auto grid = plain->deepCopy();
        grid->setTransform(openvdb::math::Transform::createLinearTransform(turned));
        const auto source = makeGridSurface("noise", grid);
        EXPECT_NEAR(source->volume(), volume * 0.5 * 0.25 * 1.5, 1e-9 * volume);
        DensityOptions options;
        options.voxelSize = 0.5;
        EXPECT_NEAR(surfaceToDensity(*source, options).metadata.gridVolume, source->volume(),
                    1e-3 * source->volume());

        // The map of the source undoes the grid's.
        const auto upright = makeGridSurface("noise", grid, {{}, turned.inverse()});
        EXPECT_NEAR(upright->volume(), volume, 1e-9 * volume);
    }
}

TEST(GridSurface, IsTheSameForAnyNumberOfThreads) {
    const auto grid = noise(40, 4);
    const auto source = [&](int threads) {
        const ThreadLimit limit(threads);
        return makeGridSurface("noise", grid);
    };
    const auto one = source(1);
    const auto two = source(2);
    EXPECT_EQ(one->volume(), two->volume());
    EXPECT_EQ(one->area(), two->area());
    EXPECT_EQ(one->elementCount(), two->elementCount());
}

TEST(GridSurface, RefusesWhatHasNoSurface) {
    EXPECT_THROW(makeGridSurface("none", nullptr), Error);
    const auto grid = noise(5, 1);
    try {
        makeGridSurface("noise", grid, {2.5, openvdb::Mat4d::identity()});
        ADD_FAILURE() << "expected an error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Result);
        EXPECT_NE(std::string(error.what()).find("2.5"), std::string::npos) << error.what();
    }
    EXPECT_THROW(makeGridSurface("noise", FloatGrid::create()), Error);
    grid->tree().setValue({0, 0, 0}, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(makeGridSurface("noise", grid), Error);
    openvdb::Mat4d flat = openvdb::Mat4d::identity();
    flat(2, 2) = 0;
    EXPECT_THROW(makeGridSurface("noise", noise(5, 1), {{}, flat}), Error);
}

}  // namespace
}  // namespace bandvox

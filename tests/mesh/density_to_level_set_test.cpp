#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

using openvdb::FloatGrid;
using openvdb::Vec3d;

FloatGrid::Ptr densityOf(const std::string& shape, int resolution) {
    DensityOptions options;
    options.resolution = resolution;
    options.tolerance = 1e-5;
    DensityResult result = surfaceToDensity(*makeShapeBoundary("shape:" + shape), options);
    setDensityMetadata(*result.grid, result.metadata);
    return result.grid;
}

// The radius at which the density of a ball crosses 0.5, by the mesh of its surface.
double radiusOf(const FloatGrid::Ptr& grid) {
    double sum = 0;
    const Mesh mesh = densityToMesh(grid, {{}, 0, 1e-5, nullptr}).surface.mesh;
    for (const Vec3d& point : mesh.points) sum += point.length();
    return sum / double(mesh.points.size());
}

TEST(DensityToLevelSet, OfABallIsItsDistance) {
    const auto grid = densityOf("sphere", 40);
    const double voxel = grid->voxelSize()[0];
    const double radius = radiusOf(grid);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const LevelSetResult result = densityToLevelSet(grid, {{}, 4, tolerance});
        EXPECT_EQ(result.grid->getGridClass(), openvdb::GRID_LEVEL_SET);
        EXPECT_EQ(result.grid->getName(), "surface");
        double worst = 0;
        for (auto value = result.grid->cbeginValueOn(); value; ++value) {
            const double truth = result.grid->indexToWorld(value.getCoord()).length() - radius;
            worst = std::max(worst, std::abs(*value - truth) / voxel);
        }
        EXPECT_LT(worst, tolerance + 2e-4) << tolerance;
        EXPECT_NEAR(result.grid->background(), 4 * voxel, 1e-6);
        // Chords lie inside of a ball of twenty voxels by up to a quarter over twenty.
        EXPECT_GT(result.largestCorrection, 3e-3);
        EXPECT_LT(result.largestCorrection, 2e-2);
        const auto accessor = result.grid->getConstAccessor();
        EXPECT_NEAR(accessor.getValue({0, 0, 0}), -4 * voxel, 1e-6) << "deep inside";
        EXPECT_NEAR(accessor.getValue({1000, 0, 0}), 4 * voxel, 1e-6);
    }
}

TEST(DensityToLevelSet, HasTheSlopeOne) {
    for (const char* shape : {"torus", "cube", "tree"}) {
        const auto grid = densityOf(shape, 64);
        const double voxel = grid->voxelSize()[0];
        const auto result = densityToLevelSet(grid);
        const auto accessor = result.grid->getConstAccessor();
        const auto density = grid->getConstAccessor();
        double sum = 0, count = 0;
        for (auto value = result.grid->cbeginValueOn(); value; ++value) {
            const openvdb::Coord at = value.getCoord();
            ASSERT_EQ(*value<0, density.getValue(at)> 0.5F) << at;
            if (std::abs(*value) > voxel) continue;
            Vec3d gradient;
            for (int axis = 0; axis < 3; ++axis) {
                openvdb::Coord before = at, after = at;
                --before[axis];
                ++after[axis];
                gradient[axis] =
                    (accessor.getValue(after) - accessor.getValue(before)) / (2 * voxel);
            }
            sum += std::abs(gradient.length() - 1);
            ++count;
        }
        ASSERT_GT(count, 300);
        EXPECT_LT(sum / count, 0.05) << shape;
    }
}

TEST(DensityToLevelSet, RebuildsALevelSetWhoseValuesAreNoDistances) {
    auto grid = openvdb::tools::createLevelSetSphere<FloatGrid>(1.0F, openvdb::Vec3f(0), 0.05F, 4);
    for (auto value = grid->beginValueOn(); value; ++value) {
        value.setValue(*value * (1.0F + 0.2F * *value / 0.2F));
    }
    const auto result = densityToLevelSet(grid);
    double worst = 0;
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        const double truth = result.grid->indexToWorld(value.getCoord()).length() - 1;
        worst = std::max(worst, std::abs(*value - truth) / 0.05);
    }
    EXPECT_LT(worst, 6e-3) << "what the spline makes of twenty voxels to a radius";
    EXPECT_EQ(result.iso, 0);
}

TEST(DensityToLevelSet, MakesFogThatIsNothingOnTheSurface) {
    const auto grid = densityOf("sphere", 40);
    const double voxel = grid->voxelSize()[0];
    const double radius = radiusOf(grid);
    const auto fog = levelSetToFog(densityToLevelSet(grid, {{}, 4, 1e-4}).grid);
    EXPECT_EQ(fog->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(fog->getName(), "density");
    EXPECT_EQ(fog->background(), 0);
    double worst = 0;
    for (auto value = fog->cbeginValueOn(); value; ++value) {
        const double depth = radius - fog->indexToWorld(value.getCoord()).length();
        const double truth = std::clamp(depth / (4 * voxel), 0.0, 1.0);
        worst = std::max(worst, std::abs(*value - truth));
    }
    EXPECT_LT(worst, 1e-3);
}

TEST(DensityToLevelSet, IsTheSameForAnyNumberOfThreads) {
    const auto grid = densityOf("two-balls", 32);
    const auto made = [&](int threads) {
        const ThreadLimit limit(threads);
        return densityToLevelSet(grid).grid;
    };
    const auto one = made(1);
    const auto two = made(2);
    ASSERT_EQ(one->activeVoxelCount(), two->activeVoxelCount());
    const auto accessor = two->getConstAccessor();
    for (auto value = one->cbeginValueOn(); value; ++value) {
        ASSERT_EQ(*value, accessor.getValue(value.getCoord()));
    }
}

TEST(DensityToLevelSet, RefusesBoxesAndNonsense) {
    const auto grid = densityOf("sphere", 20);
    const auto flat = grid->deepCopy();
    auto transform = grid->transform().copy();
    transform->preScale(Vec3d(1, 1, 2));
    flat->setTransform(transform);
    EXPECT_THROW(densityToLevelSet(flat), Error);
    EXPECT_THROW(densityToLevelSet(grid, {{}, 0.5, 1e-3}), Error);
    EXPECT_THROW(densityToLevelSet(grid, {2.0, 3, 1e-3}), Error);
    EXPECT_THROW(densityToLevelSet(nullptr), Error);
}

}  // namespace
}  // namespace bandvox

// The dense copy of a grid against a direct sum, and where it is known in closed form.

#include "grid/summary_grids.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox {
namespace {

using openvdb::Coord;
using summary_grids::denseGrid;
using summary_grids::mixedGrid;

// The sample's definition: the mean of all voxels under the tent.
double directSample(const openvdb::FloatGrid& grid, const VolumeTexture& texture,
                    const Coord& sample) {
    openvdb::Vec3d centre = texture.first;
    for (int axis = 0; axis < 3; ++axis) centre[axis] += sample[axis] * texture.spacing[axis];
    Coord low, high;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<int>(std::floor(centre[axis] - texture.spacing[axis]));
        high[axis] = static_cast<int>(std::ceil(centre[axis] + texture.spacing[axis]));
    }
    double sum = 0, weights = 0;
    for (auto voxel = openvdb::CoordBBox(low, high).begin(); voxel; ++voxel) {
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            weight *=
                std::max(0.0, 1 - std::abs((*voxel)[axis] - centre[axis]) / texture.spacing[axis]);
        }
        sum += weight * grid.tree().getValue(*voxel);
        weights += weight;
    }
    return sum / weights;
}

void expectDirectSums(const openvdb::FloatGrid& grid, int longest) {
    const VolumeTexture texture = gridToTexture(grid, longest);
    ASSERT_EQ(texture.values.size(),
              static_cast<std::size_t>(texture.size[0]) * texture.size[1] * texture.size[2]);
    double worst = 0;
    for (int x = 0; x < texture.size[0]; ++x) {
        for (int y = 0; y < texture.size[1]; ++y) {
            for (int z = 0; z < texture.size[2]; ++z) {
                worst = std::max(worst, std::abs(texture.at(x, y, z) -
                                                 directSample(grid, texture, Coord(x, y, z))));
            }
        }
    }
    EXPECT_LT(worst, 2e-6) << longest;
    EXPECT_EQ(texture.low, *std::min_element(texture.values.begin(), texture.values.end()));
    EXPECT_EQ(texture.high, *std::max_element(texture.values.begin(), texture.values.end()));
}

TEST(VolumeTexture, IsTheMeanUnderATent) {
    for (const int longest : {5, 16, 31, 57, 62}) expectDirectSums(*mixedGrid(), longest);
    for (const int longest : {16, 40}) expectDirectSums(*mixedGrid({0.5, 2, 1}), longest);
}

TEST(VolumeTexture, IsTheVoxelsWhereThereIsRoom) {
    const auto grid = mixedGrid();
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    const VolumeTexture texture = gridToTexture(*grid, 64);
    EXPECT_EQ(texture.first, box.min().asVec3d() - openvdb::Vec3d(1.0));
    EXPECT_EQ(texture.spacing, openvdb::Vec3d(1.0));
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(texture.size[axis], box.dim()[axis] + 2);
    for (int x = 0; x < texture.size[0]; ++x) {
        for (int y = 0; y < texture.size[1]; ++y) {
            for (int z = 0; z < texture.size[2]; ++z) {
                const float voxel = grid->tree().getValue(box.min().offsetBy(x - 1, y - 1, z - 1));
                ASSERT_FLOAT_EQ(texture.at(x, y, z), voxel) << x << ' ' << y << ' ' << z;
            }
        }
    }
}

TEST(VolumeTexture, SamplesAreEquallyFarInTheWorld) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(199, 99, 49)), 1.0F);
    openvdb::Mat4R matrix = openvdb::Mat4R::identity();
    matrix(0, 0) = 1;
    matrix(1, 1) = 2;
    matrix(2, 2) = 8;
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    // The longest side is 400 world units along z, of which voxels are 8.
    const VolumeTexture texture = gridToTexture(*grid, 102);
    EXPECT_NEAR(texture.spacing[0] * 1, 4, 1e-12);
    EXPECT_NEAR(texture.spacing[1] * 2, 4, 1e-12);
    EXPECT_EQ(texture.spacing[2], 1);
    EXPECT_EQ(texture.size[0], 52);
    EXPECT_EQ(texture.size[1], 52);
    EXPECT_EQ(texture.size[2], 52);
    for (const int longest : {4, 16, 33, 100, 512}) {
        const VolumeTexture some = gridToTexture(*grid, longest);
        for (const int size : some.size) EXPECT_LE(size, longest);
    }
}

TEST(VolumeTexture, LosesWavesThatTheSamplesCannotHold) {
    // Of reduction by 4, waves of a quarter cycle per voxel would become a constant.
    const auto grid = denseGrid(
        64, [](int x, int, int) { return std::cos(2 * std::numbers::pi * 0.25 * x + 0.3); });
    const VolumeTexture texture = gridToTexture(*grid, 18);
    ASSERT_NEAR(texture.spacing[0], 4, 1e-12);
    for (int x = 3; x < texture.size[0] - 3; ++x) EXPECT_NEAR(texture.at(x, 9, 9), 0, 1e-6);
}

TEST(VolumeTexture, KeepsWhatIsInactiveInside) {
    // As in a level set, where the inside is inactive and negative.
    auto grid = openvdb::FloatGrid::create(3.0F);
    grid->tree().addTile(2, Coord(0), -3.0F, false);
    for (int i = 0; i < 128; ++i) grid->tree().setValue(Coord(i, 64, 64), -3.0F);
    grid->tree().setValue(Coord(64, 0, 0), -3.0F);
    grid->tree().setValue(Coord(64, 127, 127), -3.0F);
    const VolumeTexture texture = gridToTexture(*grid, 34);
    EXPECT_EQ(texture.at(17, 10, 10), -3);
    // The first sample lies 2.5 voxels outside, and an eighth of its tent inside.
    EXPECT_NEAR(texture.at(0, 10, 10), 3 - 6.0 / 8, 1e-6);
    EXPECT_EQ(texture.low, -3);
}

TEST(VolumeTexture, TakesLargeSparseGridsAndFarVoxels) {
    // 2048³ voxels, of which only a diagonal sheet is there.
    auto grid = openvdb::FloatGrid::create(0.0F);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 2048; ++i) {
        for (int j = 0; j < 2048; j += 8) accessor.setValue(Coord(i, i, j), 1.0F);
    }
    const VolumeTexture texture = gridToTexture(*grid, 130);
    ASSERT_NEAR(texture.spacing[0], 16, 1e-9);
    EXPECT_EQ(texture.size, (std::array<int, 3>{130, 130, 128 + 2}));
    // The mean of a line of ones under a tent of half width 16 along x and y is 2/3 of 1/16.
    EXPECT_NEAR(texture.at(64, 64, 64), 1.0 / 8 * 2 / 3 / 16, 2e-5);

    auto far = openvdb::FloatGrid::create(0.0F);
    far->tree().setValue(Coord(-1000000000), 1.0F);
    far->tree().setValue(Coord(1000000000), 1.0F);
    const VolumeTexture two = gridToTexture(*far, 16);
    EXPECT_EQ(two.size, (std::array<int, 3>{16, 16, 16}));
    EXPECT_GT(two.at(1, 1, 1), 0);
    EXPECT_GT(two.at(14, 14, 14), 0);
}

TEST(VolumeTexture, CountsWhatIsNotFiniteAsBackground) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto grid = openvdb::FloatGrid::create(0.5F);
    for (int i = 0; i < 20; ++i) grid->tree().setValue(Coord(i, 0, 0), 1.0F);
    grid->tree().setValue(Coord(3, 0, 0), nan);
    grid->tree().setValue(Coord(5, 0, 0), std::numeric_limits<float>::infinity());
    grid->tree().addTile(1, Coord(0, 64, 0), nan, true);
    const VolumeTexture texture = gridToTexture(*grid, 80);
    EXPECT_EQ(texture.notFiniteValues, 3);
    EXPECT_EQ(texture.at(4, 1, 1), 0.5F);
    EXPECT_EQ(texture.at(5, 1, 1), 1.0F);
    EXPECT_EQ(texture.at(6, 1, 1), 0.5F);
    EXPECT_EQ(texture.at(4, 66, 1), 0.5F);
}

TEST(VolumeTexture, IsTheSameForAnyNumberOfThreads) {
    const auto grid = mixedGrid();
    const VolumeTexture many = gridToTexture(*grid, 33);
    const ThreadLimit one(1);
    EXPECT_EQ(gridToTexture(*grid, 33).values, many.values);
}

TEST(VolumeTexture, RefusesWhatItCannotDo) {
    const auto kindOf = [](const openvdb::FloatGrid& grid, int longest, Progress& progress) {
        try {
            gridToTexture(grid, longest, progress);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << "nothing was thrown";
        return ErrorKind::Runtime;
    };
    struct Stopped : Progress {
        bool interrupted() const override { return true; }
    } stopped;
    EXPECT_EQ(kindOf(*mixedGrid(), 3, silentProgress()), ErrorKind::Usage);
    EXPECT_EQ(kindOf(*mixedGrid(), 1025, silentProgress()), ErrorKind::Usage);
    EXPECT_EQ(kindOf(*openvdb::FloatGrid::create(), 16, silentProgress()), ErrorKind::Result);
    EXPECT_EQ(kindOf(*mixedGrid(), 16, stopped), ErrorKind::Interrupted);
}

}  // namespace
}  // namespace bandvox

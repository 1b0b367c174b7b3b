#include "grid/summary_grids.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/merge_grids.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace bandvox {
namespace {

using openvdb::Coord;
using Grids = std::vector<openvdb::FloatGrid::ConstPtr>;

constexpr MergeOperation kAll[] = {MergeOperation::Union,      MergeOperation::Sum,
                                   MergeOperation::Max,        MergeOperation::Blend,
                                   MergeOperation::Difference, MergeOperation::Intersection};

// Like a density: a ball's, with a shell of leaves, tiles inside, and a large tile far away.
openvdb::FloatGrid::Ptr ball(const Coord& center, double radius) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto accessor = grid->getAccessor();
    const int reach = static_cast<int>(radius) + 4;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                const double distance = radius - Coord(x, y, z).asVec3d().length();
                const double value = std::clamp(0.5 + distance / 4, 0.0, 1.0);
                if (value > 0) {
                    accessor.setValue(center + Coord(x, y, z), static_cast<float>(value));
                }
            }
        }
    }
    grid->pruneGrid();
    grid->tree().addTile(2, Coord(1024, 0, 0), 0.25F, true);
    return grid;
}

openvdb::FloatGrid::Ptr moved(openvdb::FloatGrid::Ptr grid, const openvdb::Vec3d& voxels) {
    grid->setTransform(grid->transform().copy());
    grid->transform().preTranslate(voxels);
    return grid;
}

// What a merge of a and b is at a voxel, from its definition.
double expectedAt(MergeOperation operation, double a, double b) {
    switch (operation) {
        case MergeOperation::Union:
            return a + b - a * b;
        case MergeOperation::Sum:
            return a + b;
        case MergeOperation::Max:
            return std::max(a, b);
        case MergeOperation::Blend:
            return (a + b) / 2;
        case MergeOperation::Difference:
            return a * (1 - b);
        default:
            return a * b;
    }
}

ErrorKind kindOf(const Grids& grids, const MergeOptions& options = {}) {
    try {
        mergeGrids(grids, options);
    } catch (const Error& error) {
        return error.kind();
    }
    return ErrorKind::Interrupted;
}

TEST(MergeGrids, EveryVoxelIsWhatItsDefinitionSays) {
    // The second's voxels are the first's moved by whole numbers that no node is aligned with, by
    // those of a leaf, or not at all.
    for (const Coord& offset : {Coord(0), Coord(8, -16, 24), Coord(-3, 5, 131), Coord(0, 0, 1)}) {
        const auto a = ball(Coord(20, 24, 28), 14);
        const auto b = moved(ball(Coord(30, 24, 28) - offset, 12), offset.asVec3d());
        for (const MergeOperation operation : kAll) {
            SCOPED_TRACE(nameOf(operation));
            const auto merged = mergeGrids({a, b}, {.operation = operation, .threshold = 0}).grid;
            double largest = 0;
            std::int64_t active = 0;
            const auto compare = [&](const Coord& at) {
                const float found = merged->tree().getValue(at);
                const double expected =
                    expectedAt(operation, a->tree().getValue(at), b->tree().getValue(at - offset));
                largest = std::max(largest, std::abs(found - expected));
                EXPECT_EQ(merged->tree().isValueOn(at), found != 0) << at;
                if (found != 0) ++active;
            };
            for (int x = -20; x < 70; ++x) {
                for (int y = -20; y < 60; ++y) {
                    for (int z = -10; z < 190; ++z) compare(Coord(x, y, z));
                }
            }
            EXPECT_LE(largest, 6e-8);
            EXPECT_GT(active, 0);
            for (const Coord& far : {Coord(1024, 0, 0), Coord(1100, 64, 130), Coord(1021, 6, 132),
                                     Coord(1151, 127, 127), Coord(1152, 0, 0), Coord(1154, 0, 0)}) {
                compare(far);
            }
        }
    }
}

TEST(MergeGrids, TilesStayTiles) {
    const auto a = openvdb::FloatGrid::create(0.0F);
    const auto b = openvdb::FloatGrid::create(0.0F);
    a->tree().addTile(3, Coord(0), 1.0F, true);
    a->tree().addTile(2, Coord(4096, 0, 0), 0.5F, true);
    b->tree().addTile(2, Coord(128, 0, 0), 0.5F, true);
    b->tree().addTile(1, Coord(8, 8, 8), 0.5F, true);
    b->tree().setValue(Coord(300, 300, 300), 0.5F);
    const auto merged = mergeGrids({a, b}, {.operation = MergeOperation::Union}).grid;
    EXPECT_EQ(merged->tree().leafCount(), 0U);
    EXPECT_EQ(merged->tree().getValueDepth(Coord(300, 300, 300)), 0);
    EXPECT_EQ(merged->tree().getValueDepth(Coord(4100, 0, 0)), 1);
    EXPECT_EQ(merged->tree().getValue(Coord(8, 8, 8)), 1.0F);
    EXPECT_EQ(merged->activeVoxelCount(), a->activeVoxelCount());

    // What is left of a large tile has a hole as large as a leaf.
    const auto cut = mergeGrids({a, b}, {.operation = MergeOperation::Difference}).grid;
    EXPECT_EQ(cut->tree().getValue(Coord(8, 8, 8)), 0.5F);
    EXPECT_EQ(cut->tree().getValue(Coord(300, 300, 300)), 0.5F);
    EXPECT_EQ(cut->tree().getValue(Coord(0)), 1.0F);
    EXPECT_EQ(cut->tree().leafCount(), 1U);
}

TEST(MergeGrids, UnionAndMaxOfThreeDoNotDependOnTheirOrder) {
    const auto a = ball(Coord(0), 9), b = ball(Coord(7, 0, 0), 9), c = ball(Coord(0, 7, 3), 11);
    for (const MergeOperation operation :
         {MergeOperation::Union, MergeOperation::Max, MergeOperation::Intersection}) {
        const auto one = mergeGrids({a, b, c}, {.operation = operation}).grid;
        const auto other = mergeGrids({c, a, b}, {.operation = operation}).grid;
        EXPECT_EQ(one->activeVoxelCount(), other->activeVoxelCount());
        for (auto value = one->cbeginValueOn(); value; ++value) {
            EXPECT_NEAR(other->tree().getValue(value.getCoord()), *value, 1.3e-7);
        }
    }
}

TEST(MergeGrids, WeightsWeighAndClampingClamps) {
    const auto a = ball(Coord(0), 8), b = ball(Coord(4, 0, 0), 8);
    MergeOptions options{.operation = MergeOperation::Sum, .weights = {2, -0.5}};
    EXPECT_EQ(mergeGrids({a, b}, options).grid->tree().getValue(Coord(0)), 1.5F);
    options.clamp = true;
    const auto clamped = mergeGrids({a, b}, options).grid;
    for (auto value = clamped->cbeginValueAll(); value; ++value) {
        EXPECT_GE(*value, 0.0F);
        EXPECT_LE(*value, 1.0F);
    }
    EXPECT_EQ(clamped->tree().getValue(Coord(0)), 1.0F);
    options = {.operation = MergeOperation::Blend, .weights = {3, 1}};
    EXPECT_EQ(mergeGrids({a, b}, options).grid->tree().getValue(Coord(-9, 0, 0)),
              0.75F * a->tree().getValue(Coord(-9, 0, 0)));
}

TEST(MergeGrids, InactiveVoxelsCountWithTheirValues) {
    const auto a = openvdb::FloatGrid::create(0.0F), b = openvdb::FloatGrid::create(0.0F);
    a->tree().setValueOff(Coord(1, 2, 3), 0.25F);
    b->tree().setValue(Coord(1, 2, 3), 0.5F);
    const auto merged = mergeGrids({a, b}, {.operation = MergeOperation::Sum}).grid;
    EXPECT_EQ(merged->tree().getValue(Coord(1, 2, 3)), 0.75F);
    EXPECT_EQ(merged->activeVoxelCount(), 1U);
}

TEST(MergeGrids, MetadataFollowFromThoseOfTheInputs) {
    const auto a = ball(Coord(0), 8), b = ball(Coord(6, 0, 0), 8);
    DensityMetadata of{.source = "a.obj",
                       .order = 2,
                       .cutoff = 0.16,
                       .iso = 0.4,
                       .tolerance = 1e-4,
                       .closureError = 2e-5,
                       .storageError = 1e-4,
                       .sourceVolume = 10,
                       .holesCapped = 1};
    setDensityMetadata(*a, of);
    of.source = "b.obj";
    of.closureError = 1e-5;
    of.samplingError = 3e-3;
    of.sourceVolume = 20;
    of.holesCapped = 2;
    of.clamped = true;
    setDensityMetadata(*b, of);

    const MergeResult united = mergeGrids({a, b});
    EXPECT_TRUE(united.warnings.empty());
    const auto merged = densityMetadata(*united.grid);
    ASSERT_TRUE(merged);
    EXPECT_EQ(merged->source, "union of a.obj and b.obj");
    EXPECT_EQ(merged->route, "merged");
    EXPECT_EQ(merged->order, 2);
    EXPECT_EQ(merged->cutoff, 0.16);
    EXPECT_EQ(merged->iso, 0.4);
    EXPECT_DOUBLE_EQ(merged->tolerance, 2e-4);
    EXPECT_DOUBLE_EQ(merged->closureError, 3e-5);
    EXPECT_DOUBLE_EQ(merged->samplingError, 3e-3);
    EXPECT_DOUBLE_EQ(merged->storageError, 2e-4);
    EXPECT_EQ(merged->sourceVolume, 0);
    EXPECT_EQ(merged->holesCapped, 3);
    EXPECT_TRUE(merged->clamped);
    EXPECT_EQ(merged->gridVolume, densityIntegral(*united.grid));
    EXPECT_EQ(united.grid->getName(), "density");
    EXPECT_EQ(united.grid->getGridClass(), openvdb::GRID_FOG_VOLUME);

    const auto blend = densityMetadata(
        *mergeGrids({a, b}, {.operation = MergeOperation::Blend, .weights = {1, 3}}).grid);
    EXPECT_DOUBLE_EQ(blend->sourceVolume, 17.5);
    EXPECT_DOUBLE_EQ(blend->closureError, 1.25e-5);
    const auto largest = densityMetadata(*mergeGrids({a, b}, {MergeOperation::Max}).grid);
    EXPECT_DOUBLE_EQ(largest->closureError, 2e-5);
}

TEST(MergeGrids, OtherFiltersAreSaidAndNotMadeUp) {
    const auto a = ball(Coord(0), 8), b = ball(Coord(6, 0, 0), 8);
    EXPECT_TRUE(mergeGrids({a, b}).warnings.empty());
    setDensityMetadata(*a, {.source = "a.obj", .order = 2, .cutoff = 0.16});
    const MergeResult half = mergeGrids({a, b});
    EXPECT_EQ(half.warnings.size(), 1U);
    EXPECT_FALSE(densityMetadata(*half.grid));
    EXPECT_EQ(sourceOf(*half.grid), "union of a.obj and unknown");
    setDensityMetadata(*b, {.order = 4, .cutoff = 0.25});
    const MergeResult different = mergeGrids({a, b});
    EXPECT_EQ(different.warnings.size(), 1U);
    EXPECT_FALSE(densityMetadata(*different.grid));
    setDensityMetadata(*b, {.order = 2, .cutoff = 0.16, .iso = 0.3});
    const MergeResult isos = mergeGrids({a, b});
    EXPECT_EQ(isos.warnings.size(), 1U);
    EXPECT_EQ(densityMetadata(*isos.grid)->iso, 0.5);
}

TEST(MergeGrids, IsTheSameForAnyNumberOfThreads) {
    const auto a = ball(Coord(0), 30), b = moved(ball(Coord(20, 9, 0), 30), {3, 0, -5});
    openvdb::FloatGrid::Ptr results[2];
    for (int i = 0; i < 2; ++i) {
        const ThreadLimit limit(i == 0 ? 1 : 4);
        results[i] = mergeGrids({a, b}).grid;
    }
    EXPECT_TRUE(results[0]->tree().hasSameTopology(results[1]->tree()));
    for (auto value = results[0]->cbeginValueOn(); value; ++value) {
        EXPECT_EQ(results[1]->tree().getValue(value.getCoord()), *value);
    }
}

TEST(MergeGrids, RefusesWhatItCannotMerge) {
    const auto a = ball(Coord(0), 6), b = ball(Coord(40, 0, 0), 6);
    EXPECT_EQ(kindOf({a, b}), ErrorKind::Interrupted) << "this one works";
    EXPECT_EQ(kindOf({a}), ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, nullptr}), ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, b}, {.weights = {1, 1}}), ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, b}, {.operation = MergeOperation::Sum, .weights = {1}}), ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, b}, {.operation = MergeOperation::Blend, .weights = {0, 0}}),
              ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, b}, {.operation = MergeOperation::Blend, .weights = {2, -1}}),
              ErrorKind::Usage);
    EXPECT_EQ(kindOf({a, b}, {.threshold = -1}), ErrorKind::Usage);

    auto apart = openvdb::FloatGrid::create(0.0F);
    apart->tree().setValue(Coord(5, 5, 5), 1.0F);
    apart->tree().addTile(1, Coord(64, 64, 64), 1.0F, true);
    auto alone = openvdb::FloatGrid::create(0.0F);
    alone->tree().setValue(Coord(-9, 5, 5), 1.0F);
    EXPECT_EQ(kindOf({apart, alone}, {.operation = MergeOperation::Intersection}),
              ErrorKind::Result);

    const auto levelSet = b->deepCopy();
    levelSet->setGridClass(openvdb::GRID_LEVEL_SET);
    EXPECT_EQ(kindOf({a, levelSet}), ErrorKind::Input);
    EXPECT_EQ(kindOf({a, summary_grids::mixedGrid()}), ErrorKind::Input) << "background";
    const auto broken = b->deepCopy();
    broken->tree().setValue(Coord(40, 0, 3), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(kindOf({a, broken}), ErrorKind::Input);
    broken->tree().setValue(Coord(40, 0, 3), 1);
    broken->tree().addTile(1, Coord(80, 0, 0), std::numeric_limits<float>::infinity(), true);
    EXPECT_EQ(kindOf({a, broken}), ErrorKind::Input);

    EXPECT_EQ(kindOf({a, moved(b->deepCopy(), {0.5, 0, 0})}), ErrorKind::Input);
    const auto larger = b->deepCopy();
    larger->setTransform(openvdb::math::Transform::createLinearTransform(1.5));
    EXPECT_EQ(kindOf({a, larger}), ErrorKind::Input);
}

}  // namespace
}  // namespace bandvox

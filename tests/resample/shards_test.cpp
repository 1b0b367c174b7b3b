// Parts of grids, made apart and joined, against the whole.

#include "stop_after.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/join_shards.h>
#include <bandvox/resample/resample_grid.h>
#include <bandvox/source/joined_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::FloatGrid;
using openvdb::GridBase;

// Every value and every tile.
template <typename Grid>
void expectSame(const Grid& whole, const Grid& joined) {
    EXPECT_TRUE(whole.tree().hasSameTopology(joined.tree()));
    EXPECT_EQ(whole.tree().activeTileCount(), joined.tree().activeTileCount());
    EXPECT_EQ(whole.tree().leafCount(), joined.tree().leafCount());
    EXPECT_EQ(whole.background(), joined.background());
    const auto accessor = joined.getConstAccessor();
    for (auto value = whole.cbeginValueAll(); value; ++value) {
        ASSERT_EQ(*value, accessor.getValue(value.getCoord())) << value.getCoord();
        ASSERT_EQ(value.isValueOn(), accessor.isValueOn(value.getCoord())) << value.getCoord();
    }
}

void expectSameMetadata(const GridBase& whole, const GridBase& joined) {
    for (auto entry = whole.beginMeta(); entry != whole.endMeta(); ++entry) {
        const auto other = joined[entry->first];
        ASSERT_TRUE(other) << entry->first;
        EXPECT_TRUE(*entry->second == *other)
            << entry->first << ": " << entry->second->str() << ", " << other->str();
    }
    EXPECT_EQ(whole.metaCount(), joined.metaCount());
}

using MakePart = std::function<GridBase::Ptr(const Shard&)>;

JoinedGrid join(int count, const MakePart& make) {
    std::vector<GridBase::Ptr> parts;
    std::vector<std::string> names;
    // Their order does not matter.
    for (int i = count; i >= 1; --i) {
        parts.push_back(make({i, count}));
        names.push_back("part" + std::to_string(i));
    }
    return joinShards(parts, names);
}

void expectWhole(const MakePart& make) {
    const auto whole = openvdb::gridPtrCast<FloatGrid>(make({}));
    for (const int count : {2, 7, 40}) {
        SCOPED_TRACE(count);
        const JoinedGrid joined = join(count, make);
        expectSame(*whole, *openvdb::gridPtrCast<FloatGrid>(joined.grid));
        expectSameMetadata(*whole, *joined.grid);
    }
}

DensityOptions smallTiles(const Shard& shard, double voxelSize) {
    DensityOptions options;
    options.voxelSize = voxelSize;
    options.tile = 34;  // the interiors are no multiples of a leaf's side
    options.shard = shard;
    return options;
}

TEST(Shards, OfTheExactRouteJoinToTheWhole) {
    for (const char* shape : {"torus", "two-balls", "cube"}) {
        SCOPED_TRACE(shape);
        const auto source = makeShapeBoundary(std::string("shape:") + shape);
        expectWhole([&](const Shard& shard) {
            return surfaceToDensity(*source, smallTiles(shard, 0.021)).grid;
        });
    }
}

TEST(Shards, HoldsEachStepOnceAndAsManyAsTheOthers) {
    for (const int count : {1, 3, 4}) {
        std::vector<int> held(static_cast<std::size_t>(count), 0);
        for (std::int64_t step = 0; step < 38; ++step) {
            int holders = 0;
            for (int index = 1; index <= count; ++index) {
                if (!Shard{index, count}.holds(step)) continue;
                ++holders;
                ++held[static_cast<std::size_t>(index - 1)];
            }
            EXPECT_EQ(holders, 1);
        }
        const auto [least, most] = std::minmax_element(held.begin(), held.end());
        EXPECT_LE(*most - *least, 1);
    }
}

TEST(Shards, OfALargeSolidHaveItsTiles) {
    // Tiles of 128³ voxels lie across parts.
    const auto source = makeShapeBoundary("shape:cube");
    const double side = source->bounds().extents()[0];
    DensityOptions options;
    options.voxelSize = side / 300;
    expectWhole([&](const Shard& shard) {
        options.shard = shard;
        return surfaceToDensity(*source, options).grid;
    });
}

TEST(Shards, AreLimitedWhereShellsOverlapInAnother) {
    const auto ball = makeShapeBoundary("shape:sphere");
    const auto torus = makeShapeBoundary("shape:torus");
    const JoinedSource both("both", {ball.get(), torus.get()});
    for (const ExponentialFilter& filter : {ExponentialFilter{2, 0.16}, {4, 0.25}}) {
        const auto make = [&](const Shard& shard) {
            DensityOptions options = smallTiles(shard, 0.05);
            options.filter = filter;
            return surfaceToDensity(both, options);
        };
        EXPECT_TRUE(make({}).metadata.clamped);
        expectWhole([&](const Shard& shard) { return make(shard).grid; });
        EXPECT_FALSE(
            join(3, [&](const Shard& shard) { return make(shard).grid; }).warnings.empty());
    }
}

TEST(Shards, OfTheSampledRouteJoinToTheWhole) {
    const auto source = makeShapeField("shape:torus");
    expectWhole([&](const Shard& shard) {
        FieldDensityOptions options;
        options.density = smallTiles(shard, 0.05);
        options.oversample = 4;
        return fieldToDensity(*source, options).grid;
    });
}

TEST(Shards, OfResampledGridsJoinToTheWhole) {
    const auto density = surfaceToDensity(*makeShapeBoundary("shape:torus")).grid;
    const auto levelSet =
        openvdb::tools::createLevelSetSphere<FloatGrid>(1.0F, openvdb::Vec3f(0), 0.02F);
    for (const auto& source : {density, levelSet}) {
        for (const double factor : {1.7, 7.0}) {
            expectWhole([&](const Shard& shard) {
                ResampleOptions options;
                options.shard = shard;
                const auto lattice = source->transform().copy();
                lattice->preScale(factor);
                return resampleGrid(source, *lattice, options).grid;
            });
        }
    }
}

TEST(Shards, AreJoinedUntilTheWorkIsToStop) {
    const auto source = makeShapeBoundary("shape:torus");
    std::vector<GridBase::Ptr> made;
    for (int i = 1; i <= 3; ++i) {
        made.push_back(surfaceToDensity(*source, smallTiles({i, 3}, 0.05)).grid);
    }
    expectStopsMidway(100, [&](Progress& progress) {
        std::vector<GridBase::Ptr> parts;
        for (const auto& part : made) parts.push_back(part->deepCopyGrid());
        joinShards(parts, {"a", "b", "c"}, progress);
    });
}

ErrorKind kindOfJoining(const std::vector<GridBase::Ptr>& parts) {
    try {
        joinShards(parts, std::vector<std::string>(parts.size(), "part"));
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()), "");
        return error.kind();
    }
    return ErrorKind::Runtime;
}

TEST(Shards, AreRefusedIfTheyAreNoWhole) {
    const auto source = makeShapeBoundary("shape:torus");
    const auto make = [&](const Shard& shard, double voxel = 0.1) {
        return surfaceToDensity(*source, smallTiles(shard, voxel)).grid;
    };
    EXPECT_EQ(kindOfJoining({make({1, 3}), make({3, 3})}), ErrorKind::Input) << "missing";
    EXPECT_EQ(kindOfJoining({make({1, 2}), make({1, 2}), make({2, 2})}), ErrorKind::Input);
    EXPECT_EQ(kindOfJoining({make({1, 2}), make({2, 3})}), ErrorKind::Input);
    EXPECT_EQ(kindOfJoining({make({1, 2}), make({})}), ErrorKind::Input);
    EXPECT_EQ(kindOfJoining({make({1, 2}), make({2, 2}, 0.11)}), ErrorKind::Input);
    EXPECT_EQ(kindOfJoining({}), ErrorKind::Usage);
    const auto other = make({2, 2});
    other->setName("other");
    EXPECT_EQ(kindOfJoining({make({1, 2}), other}), ErrorKind::Input);
    EXPECT_THROW(make({0, 2}), Error);
    EXPECT_THROW(make({3, 2}), Error);
}

}  // namespace
}  // namespace bandvox

#include "render/surface_blocks.h"

#include "stop_after.h"

#include <bandvox/core/memory.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace {

using bandvox::Ray;
using bandvox::SurfaceBlocks;
using openvdb::Coord;
using openvdb::Vec3d;

std::vector<std::pair<double, double>> spans(const SurfaceBlocks& blocks, const Ray& ray) {
    std::vector<std::pair<double, double>> all;
    blocks.walk(ray, 1e30, [&](double t0, double t1) {
        all.emplace_back(t0, t1);
        return false;
    });
    return all;
}

// A few voxels and tiles of different sizes far apart, on both sides of 0.
openvdb::FloatGrid::Ptr scatteredGrid() {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    std::mt19937 random(3);
    std::uniform_int_distribution<int> place(-150, 150);
    for (int i = 0; i < 60; ++i) {
        accessor.setValue(Coord(place(random), place(random), place(random)), i % 2 ? 1.0F : 0.3F);
    }
    grid->tree().addTile(1, Coord(-64, 8, 40), 1.0F, true);     // 8³ voxels
    grid->tree().addTile(2, Coord(128, 128, 128), 1.0F, true);  // 128³ voxels
    return grid;
}

TEST(SurfaceBlocks, MeetsEveryPlaceNearAHighValue) {
    const auto grid = scatteredGrid();
    const SurfaceBlocks blocks(*grid, 0.5);
    EXPECT_EQ(blocks.maximum(), 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-200, 300), offset(-0.95, 0.95);
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        if (value.getValue() < 0.5F) continue;
        for (int i = 0; i < 200; ++i) {
            // A line of sight with a direction of any length, to a place near the value's box.
            const Vec3d origin(place(random), place(random), place(random));
            const auto box = value.getBoundingBox();
            const Vec3d corner = (i % 2 ? box.min() : box.max()).asVec3d();
            const Vec3d target = corner + Vec3d(offset(random), offset(random), offset(random));
            const auto all = spans(blocks, {origin, (target - origin) * 0.37});
            bool met = false;
            for (const auto& [t0, t1] : all) {
                met = met || (t0 <= 1 / 0.37 + 1e-9 && t1 >= 1 / 0.37 - 1e-9);
            }
            ASSERT_TRUE(met) << origin << target;
            for (std::size_t s = 1; s < all.size(); ++s) {
                ASSERT_GE(all[s].first, all[s - 1].second - 1e-9) << "out of order";
            }
        }
    }
}

// Blocks are those of the voxels beside a high one, in all directions, and no others.
TEST(SurfaceBlocks, AreThoseAroundHighValues) {
    std::mt19937 random(9);
    for (int round = 0; round < 20; ++round) {
        auto grid = openvdb::FloatGrid::create(0);
        std::set<Coord> expected;
        const auto expect = [&](const Coord& at) {
            for (int i = 0; i < 27; ++i) {
                expected.insert(at.offsetBy(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) >> 2);
            }
        };
        for (int i = 0; i < 3; ++i) {
            const Coord at(random() % 60 - 30, random() % 60 - 30, random() % 60 - 30);
            grid->tree().setValue(at, 0.6F);
            grid->tree().setValue(at.offsetBy(2, 0, 1), 0.4F);
            expect(at);
        }
        const Coord full(64, 0, 8 * (round % 5));  // a leaf, or a tile
        if (round % 2 == 0) grid->fill(openvdb::CoordBBox::createCube(full, 8), 1.0F);
        if (round % 2 == 1) grid->tree().addTile(1, full, 1.0F, true);
        if (round % 4 == 0) grid->tree().voxelizeActiveTiles();
        for (int v = 0; v < 512; ++v) expect(full + Coord(v & 7, v >> 3 & 7, v >> 6));

        std::set<Coord> found;
        const SurfaceBlocks blocks(*grid, 0.5);
        for (const SurfaceBlocks::Group& group : blocks.groups()) {
            ASSERT_NE(group.rows, nullptr);
            for (int b = 0; b < 512; ++b) {
                if ((group.rows[b >> 6] >> (b & 63) & 1) == 0) continue;
                found.insert((group.first >> 2) + Coord(b >> 6, b >> 3 & 7, b & 7));
            }
        }
        EXPECT_EQ(found, expected) << round;
    }
}

TEST(SurfaceBlocks, SkipsWhatIsFarFromHighValues) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().setValue(Coord(100, 100, 100), 1.0F);
    grid->tree().setValue(Coord(20, 20, 20), 0.4F);
    const SurfaceBlocks blocks(*grid, 0.5);
    EXPECT_TRUE(spans(blocks, {Vec3d(0, 20, 20), Vec3d(1, 0, 0)}).empty());
    EXPECT_TRUE(spans(blocks, {Vec3d(200, 100, 100), Vec3d(1, 0, 0)}).empty()) << "behind";
    double length = 0;
    for (const auto& [t0, t1] : spans(blocks, {Vec3d(0, 100, 100), Vec3d(1, 0, 0)})) {
        length += t1 - t0;
    }
    EXPECT_GE(length, 3);
    EXPECT_LE(length, 8);
    EXPECT_FALSE(spans(blocks, {Vec3d(100, 100, 100), Vec3d(0, 0, 1)}).empty()) << "from inside";
}

TEST(SurfaceBlocks, IsEmptyWithoutHighValues) {
    auto grid = openvdb::FloatGrid::create(0);
    EXPECT_TRUE(SurfaceBlocks(*grid, 0.5).empty());
    grid->tree().setValue(Coord(1, 2, 3), 0.4F);
    const SurfaceBlocks blocks(*grid, 0.5);
    EXPECT_TRUE(blocks.empty());
    EXPECT_FLOAT_EQ(static_cast<float>(blocks.maximum()), 0.4F);
    EXPECT_TRUE(spans(blocks, {Vec3d(0, 0, 0), Vec3d(1, 2, 3)}).empty());
}

TEST(SurfaceBlocks, NoticesValuesThatAreNotFinite) {
    for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
        auto grid = openvdb::FloatGrid::create(0);
        grid->tree().setValue(Coord(1, 2, 3), 1.0F);
        EXPECT_TRUE(SurfaceBlocks(*grid, 0.5).finite());
        grid->tree().addTile(1, Coord(64), value, true);
        EXPECT_FALSE(SurfaceBlocks(*grid, 0.5).finite()) << value;
        grid->tree().addTile(1, Coord(64), 1.0F, true);
        grid->tree().setValue(Coord(0, 0, 0), value);
        EXPECT_FALSE(SurfaceBlocks(*grid, 0.5).finite()) << value;
    }
}

// Leaves are needed only for the blocks beside what tiles fill.
TEST(SurfaceBlocks, TakeMemoryByTheSurfaceOfWhatTilesFill) {
    for (const int level : {2, 3}) {
        const int side = level == 2 ? 128 : 4096;
        auto grid = openvdb::FloatGrid::create(0);
        for (const int x : {1, 0}) {
            for (const int y : {0, 1}) {
                for (int z = 0; z < 4 - level; ++z) {
                    grid->tree().addTile(level, Coord(side * x, side * y, side * z), 1.0F, true);
                }
            }
        }
        const SurfaceBlocks blocks(*grid, 0.5);
        std::size_t leaves = 0;
        double inside = 0;  // blocks of those that are whole
        for (const SurfaceBlocks::Group& group : blocks.groups()) {
            if (group.rows) {
                ++leaves;
            } else {
                inside += std::pow(group.side, 3);
            }
        }
        const std::size_t n = side / 32, xy = 2 * n, z = (4 - level) * n;
        EXPECT_EQ(leaves, (xy + 2) * (xy + 2) * (z + 2) - xy * xy * z);
        EXPECT_EQ(inside, 512.0 * xy * xy * z);
        // The blocks beside the walls between the tiles, too.
        const openvdb::Vec3d through(side - 0.5, side + 0.25, -10);
        double length = 0;
        for (const auto& [t0, t1] : spans(blocks, {through, Vec3d(0, 0, 1)})) length += t1 - t0;
        EXPECT_NEAR(length, (4 - level) * side + 2 * SurfaceBlocks::kSide, 1e-6);
    }
}

// A plate of tiles whose surface alone would take some 80 GB.
TEST(SurfaceBlocks, RefuseWhatMemoryDoesNotHold) {
    if (bandvox::availableMemory() > std::int64_t(60) << 30) GTEST_SKIP() << "it has enough";
    auto grid = openvdb::FloatGrid::create(0);
    for (int x = 0; x < 100; ++x) {
        for (int y = 0; y < 100; ++y) {
            grid->tree().addTile(3, Coord(4096 * x, 4096 * y, 0), 1.0F, true);
        }
    }
    try {
        const SurfaceBlocks blocks(*grid, 0.5);
        FAIL() << "nothing was thrown";
    } catch (const bandvox::Error& error) {
        EXPECT_EQ(error.kind(), bandvox::ErrorKind::Memory) << error.what();
    }
}

TEST(SurfaceBlocks, AskWhetherToStop) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(3, Coord(0), 1.0F, true);
    bandvox::expectStopsMidway(
        500, [&](bandvox::Progress& progress) { SurfaceBlocks(*grid, 0.5, progress); });
}

TEST(SurfaceBlocks, StopsWhenToldTo) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(2, Coord(0), 1.0F, true);
    const SurfaceBlocks blocks(*grid, 0.5);
    int visits = 0;
    blocks.walk({Vec3d(-50, 3, 3), Vec3d(1, 0, 0)}, 1e30,
                [&](double, double) { return ++visits == 2; });
    EXPECT_EQ(visits, 2);
}

}  // namespace

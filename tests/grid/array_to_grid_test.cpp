#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_to_grid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Coord;

// Numbers that follow from the place, in a file's order.
class FormulaArray final : public ArraySource {
  public:
    FormulaArray(const Coord& size, std::array<int, 3> axes, float (*value)(const Coord&))
        : ArraySource(makeInfo(size, axes)), mValue(value) {}

    void readSlices(std::span<float> values) override {
        const ArrayInfo& array = info();
        for (float& value : values) {
            Coord at;
            at[array.axes[0]] = static_cast<int>(mNext % array.size[array.axes[0]]);
            at[array.axes[1]] =
                static_cast<int>(mNext / array.size[array.axes[0]] % array.size[array.axes[1]]);
            at[array.axes[2]] = static_cast<int>(mNext / array.valuesPerSlice());
            value = mValue(at);
            ++mNext;
        }
    }

  private:
    static ArrayInfo makeInfo(const Coord& size, std::array<int, 3> axes) {
        ArrayInfo info;
        info.name = "folder/formula.npy";
        info.size = size;
        info.axes = axes;
        info.toWorld = openvdb::Mat4d::identity();
        info.toWorld(0, 1) = 0.5;
        info.toWorld(3, 2) = 7;
        info.space = "LPS";
        return info;
    }

    float (*mValue)(const Coord&);
    std::int64_t mNext = 0;
};

float mixed(const Coord& at) {
    if (at[0] < 17 && at[1] >= 8) return 3;  // whole leaves of it, and parts
    if (at[2] % 5 == 0) return -1;           // background
    return static_cast<float>(at[0] + 100 * at[1] + 10000 * at[2]);
}

TEST(ArrayToGrid, KeepsEveryValueInEitherOrder) {
    const Coord size(37, 21, 30);
    for (const std::array<int, 3>& axes : {std::array{0, 1, 2}, std::array{2, 1, 0}}) {
        FormulaArray source(size, axes, mixed);
        const auto grid = arrayToGrid(source, {-1, 0});
        EXPECT_EQ(grid->background(), -1);
        EXPECT_EQ(grid->getName(), "density");
        EXPECT_EQ(grid->metaValue<std::string>("bandvox_space"), "LPS");
        EXPECT_EQ(grid->metaValue<std::string>("bandvox_source"), "formula.npy");
        EXPECT_EQ(grid->indexToWorld(Coord(2, 0, 0)), openvdb::Vec3d(2, 1, 7));
        EXPECT_GT(grid->tree().activeTileCount(), 0U) << "whole leaves of one value";
        auto accessor = grid->getConstAccessor();
        for (int x = -1; x <= size[0]; ++x) {
            for (int y = -1; y <= size[1]; ++y) {
                for (int z = -1; z <= size[2]; ++z) {
                    const Coord at(x, y, z);
                    const bool inside =
                        x >= 0 && y >= 0 && z >= 0 && x < size[0] && y < size[1] && z < size[2];
                    const float expected = inside ? mixed(at) : -1;
                    ASSERT_EQ(accessor.getValue(at), expected) << at;
                    ASSERT_EQ(accessor.isValueOn(at), expected != -1) << at;
                }
            }
        }
    }
}

TEST(ArrayToGrid, LeavesAwayWhatIsNearTheBackground) {
    FormulaArray source(Coord(20), {0, 1, 2},
                        [](const Coord& at) { return at[0] == 3 ? 0.5F : 0.01F; });
    const auto grid = arrayToGrid(source, {0, 0.05F});
    EXPECT_EQ(grid->activeVoxelCount(), 400U);
}

TEST(ArrayToGrid, IsTheSameForAnyNumberOfThreads) {
    const auto read = [](int threads) {
        const ThreadLimit limit(threads);
        FormulaArray source(Coord(37, 21, 30), {0, 1, 2}, mixed);
        return arrayToGrid(source);
    };
    const auto one = read(1), four = read(4);
    EXPECT_TRUE(one->tree().hasSameTopology(four->tree()));
    EXPECT_EQ(one->activeVoxelCount(), four->activeVoxelCount());
}

TEST(ArrayToGrid, RefusesValuesThatAreNotFinite) {
    FormulaArray source(Coord(20), {0, 1, 2}, [](const Coord& at) {
        return at == Coord(9, 10, 11) ? std::numeric_limits<float>::quiet_NaN() : 1.0F;
    });
    try {
        arrayToGrid(source);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(error.what()).find("(8, 8, 8)"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace bandvox

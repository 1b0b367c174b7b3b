#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_to_solid_grid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Coord;

// Numbers that follow from the place, in a file's order.
class PlacedArray final : public ArraySource {
  public:
    using Value = std::function<double(const Coord&)>;
    PlacedArray(const Coord& size, std::array<int, 3> axes, Value value)
        : ArraySource(makeInfo(size, axes)), mValue(std::move(value)) {}

    void readSlices(std::span<float> values) override {
        const ArrayInfo& array = info();
        for (float& value : values) {
            Coord at;
            at[array.axes[0]] = static_cast<int>(mNext % array.size[array.axes[0]]);
            at[array.axes[1]] =
                static_cast<int>(mNext / array.size[array.axes[0]] % array.size[array.axes[1]]);
            at[array.axes[2]] = static_cast<int>(mNext / array.valuesPerSlice());
            value = static_cast<float>(mValue(at));
            ++mNext;
        }
    }

    bool isAtEnd() const { return mNext == info().valuesPerSlice() * info().slices(); }

  private:
    static ArrayInfo makeInfo(const Coord& size, std::array<int, 3> axes) {
        ArrayInfo info;
        info.name = "folder/placed.npy";
        info.size = size;
        info.axes = axes;
        info.toWorld = openvdb::Mat4d::identity();
        info.toWorld(3, 1) = 5;
        return info;
    }

    Value mValue;
    std::int64_t mNext = 0;
};

double ballValue(const Coord& at) {
    return 30 - (at.asVec3d() - openvdb::Vec3d(26, 19.3, 31)).length();
}

double waves(const Coord& at) {
    return std::sin(0.9 * at[0]) + std::sin(1.1 * at[1] + 0.3 * at[2]) + std::sin(0.7 * at[2]);
}

double depthOf(double value, const ArraySolidOptions& options) {
    return std::min(value - options.low, options.high - value);
}

// All 26 neighbours of a voxel that is on the other side of the surface than they are, or beside
// one that is, have their own values; others the same sign.
void expectSolid(const Coord& size, const std::array<int, 3>& axes, const PlacedArray::Value& value,
                 const ArraySolidOptions& options) {
    PlacedArray source(size, axes, value);
    const auto grid = arrayToSolidGrid(source, options);
    EXPECT_TRUE(source.isAtEnd());
    const auto depth = [&](const Coord& at) {
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] < 0 || at[axis] >= size[axis]) return depthOf(options.outside, options);
        }
        return depthOf(static_cast<float>(value(at)), options);
    };
    const auto accessor = grid->getConstAccessor();
    for (int x = -2; x < size[0] + 2; ++x) {
        for (int y = -2; y < size[1] + 2; ++y) {
            for (int z = -2; z < size[2] + 2; ++z) {
                const Coord at(x, y, z);
                const double expected = depth(at);
                const double found = accessor.getValue(at);
                ASSERT_EQ(found > 0, static_cast<float>(expected) > 0) << at;
                bool isNear = false;
                for (int i = 0; i < 27 && !isNear; ++i) {
                    const Coord next = at.offsetBy(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                    isNear = (depth(next) > 0) != (expected > 0);
                }
                if (isNear) {
                    ASSERT_EQ(found, static_cast<float>(expected)) << at;
                }
            }
        }
    }
}

TEST(ArrayToSolidGrid, KeepsWhatTheSurfaceNeeds) {
    const double none = std::numeric_limits<double>::infinity();
    for (const std::array<int, 3>& axes : {std::array{0, 1, 2}, std::array{2, 1, 0}}) {
        expectSolid({57, 41, 67}, axes, ballValue, {10, none, 0});
        expectSolid({40, 33, 25}, axes, waves, {0.5, none, 0});
        expectSolid({40, 33, 25}, axes, waves, {-0.5, 0.4, -5});
        expectSolid({16, 8, 9}, axes, [](const Coord&) { return 7.0; }, {2, none, 0});
        expectSolid({1, 1, 1}, axes, [](const Coord&) { return 7.0; }, {2, none, 0});
        expectSolid({9, 9, 17}, axes, [](const Coord& at) { return at[2] == 8 ? 9.0 : 0.0; },
                    {2, none, 0});
    }
}

TEST(ArrayToSolidGrid, StoresOnlyTheSurfaceAndSaysWhereItIs) {
    PlacedArray source({120, 120, 120}, {0, 1, 2}, [](const Coord& at) {
        return 50 - (at.asVec3d() - openvdb::Vec3d(60)).length();
    });
    const auto grid = arrayToSolidGrid(source, {});
    // A ball's surface meets about 1.5 · 4π r² / 8² blocks.
    EXPECT_LT(grid->tree().leafCount(), 1.2 * 1.5 * 4 * std::numbers::pi * 50 * 50 / 64 * 1.7);
    EXPECT_GT(grid->tree().activeTileCount(), 0U);
    EXPECT_EQ(grid->indexToWorld(Coord(1, 2, 3)), openvdb::Vec3d(1, 7, 3));
    EXPECT_EQ(grid->metaValue<std::string>("bandvox_source"), "placed.npy");
}

TEST(ArrayToSolidGrid, IsTheSameForAnyNumberOfThreads) {
    const auto made = [](int threads) {
        const ThreadLimit limit(threads);
        PlacedArray source({70, 50, 40}, {2, 1, 0}, waves);
        return arrayToSolidGrid(source, {0.2, 1.5, 0});
    };
    const auto one = made(1);
    const auto two = made(2);
    EXPECT_TRUE(one->tree().hasSameTopology(two->tree()));
    const auto accessor = two->getConstAccessor();
    for (auto value = one->cbeginValueOn(); value; ++value) {
        ASSERT_EQ(*value, accessor.getValue(value.getCoord()));
    }
}

ErrorKind kindOf(const ArraySolidOptions& options, const PlacedArray::Value& value) {
    PlacedArray source({20, 20, 20}, {0, 1, 2}, value);
    try {
        arrayToSolidGrid(source, options);
    } catch (const Error& error) {
        return error.kind();
    }
    return ErrorKind::Runtime;
}

TEST(ArrayToSolidGrid, RefusesNonsense) {
    const double none = std::numeric_limits<double>::infinity();
    EXPECT_EQ(kindOf({5, 5, 0}, waves), ErrorKind::Usage);
    EXPECT_EQ(kindOf({-1, none, 0}, waves), ErrorKind::Usage) << "the outside is inside";
    EXPECT_EQ(kindOf({std::nan(""), none, 0}, waves), ErrorKind::Usage);
    EXPECT_EQ(kindOf({5, none, 0}, waves), ErrorKind::Result) << "nothing is";
    EXPECT_EQ(
        kindOf({0.5, none, 0},
               [](const Coord& at) { return at == Coord(19, 3, 11) ? std::nan("") : waves(at); }),
        ErrorKind::Input);
}

}  // namespace
}  // namespace bandvox

// Bricks that are made ready only where they are mostly read.

#include "reconstruct/coefficient_brick.h"
#include "reconstruct/nodes_in_band.h"

#include <bandvox/core/parallel.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

constexpr DensityBand kBand{0.2F, 0.8F};

// A ball's density, smooth across its surface, with tiles deep inside.
openvdb::FloatGrid::Ptr ball(double radius, const Vec3d& center) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    const int reach = static_cast<int>(radius) + 8;
    const Coord middle = Coord::round(center);
    for (auto it = CoordBBox(middle.offsetBy(-reach), middle.offsetBy(reach)).begin(); it; ++it) {
        const double r = ((*it).asVec3d() - center).length();
        const auto value = static_cast<float>(0.5 * std::erfc(0.5 * (r - radius)));
        if (value > 1e-4F) accessor.setValue(*it, value);
    }
    grid->tree().prune();
    return grid;
}

// The nodes in a band, looked at one by one.
CoordBBox slowNodesInBand(const openvdb::FloatGrid& grid, const CoordBBox& box) {
    CoordBBox found;
    const auto values = grid.getConstAccessor();
    for (auto it = box.begin(); it; ++it) {
        const float value = values.getValue(*it);
        if (value >= kBand.low && value <= kBand.high) found.expand(*it);
    }
    return found;
}

TEST(NodesInBand, AreThoseFoundOneByOne) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> place(-40, 40), side(1, 34);
    const auto smooth = ball(21.3, {0.2, 3.1, -1.7});
    // Few nodes anywhere, and a tile.
    const auto sparse = openvdb::FloatGrid::create(0);
    for (int i = 0; i < 30; ++i) {
        sparse->tree().setValue({place(random), place(random), place(random)},
                                0.1F * float(i % 11));
    }
    sparse->tree().addTile(1, {8, -16, 24}, 0.5F, true);
    int some = 0;
    for (const auto& grid : {smooth, sparse}) {
        const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> values(grid->tree());
        for (int i = 0; i < 300; ++i) {
            const Coord first(place(random), place(random), place(random));
            const CoordBBox box(first, first.offsetBy(side(random), side(random), side(random)));
            const CoordBBox expected = slowNodesInBand(*grid, box);
            const CoordBBox found = nodesInBand(values, box, kBand);
            ASSERT_EQ(found.empty(), expected.empty());
            if (expected.empty()) continue;
            ASSERT_EQ(found, expected) << box;
            ++some;
        }
    }
    EXPECT_GT(some, 100);
}

// Of every kernel: the filter's, and the spline's.
std::vector<InterpolationDesign> designs() {
    std::vector<InterpolationDesign> all{splineInterpolation()};
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        all.push_back(designInterpolation({2, 0.16}, tolerance));
    }
    return all;
}

TEST(PartialBrick, HoldsWhatIsMostlyReadAndReadsTheSame) {
    // A face along z, which leaves most of the brick out.
    const auto grid = openvdb::FloatGrid::create(0);
    for (auto it = CoordBBox(Coord(-50, -50, -24), Coord(50, 50, 60)).begin(); it; ++it) {
        const auto value = static_cast<float>(0.5 * std::erfc(0.6 * ((*it)[2] - 11.3)));
        grid->tree().setValue(*it, value);
    }
    BrickScratch scratch;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> along(0, CoefficientBrick::kSide);
    for (const InterpolationDesign& design : designs()) {
        const CoefficientBrick whole(*grid, Coord(0), design, std::nullopt, scratch);
        const CoefficientBrick partial(*grid, Coord(0), design, kBand, scratch);
        int held = 0, left = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3d place(along(random), along(random), along(random));
            EXPECT_TRUE(whole.holds(place));
            const float nearest = grid->tree().getValue(Coord::round(place));
            const bool mostlyRead = nearest >= kBand.low && nearest <= kBand.high;
            if (!partial.holds(place)) {
                EXPECT_FALSE(mostlyRead) << place;
                ++left;
                continue;
            }
            ++held;
            const DensityExpansion a = whole.expand(design.kernel, place);
            const DensityExpansion b = partial.expand(design.kernel, place);
            ASSERT_EQ(a.value, b.value) << place;
            ASSERT_EQ(a.gradient, b.gradient) << place;
            ASSERT_EQ(a.hessian, b.hessian) << place;
            ASSERT_EQ(whole.value(design.kernel, place), partial.value(design.kernel, place));
        }
        EXPECT_GT(held, 200);
        EXPECT_GT(left, 1000) << "the brick is not made ready in part";
    }
}

TEST(PartialBrick, IsMadeWholeForWhoReadsElsewhere) {
    const auto grid = ball(37.4, {1.3, -2.2, 0.9});
    constexpr int kTasks = 4, kPlaces = 25;
    const auto readAll = [&](const std::optional<DensityBand>& mostlyRead, int threads,
                             std::size_t cacheBytes) {
        const ThreadLimit limit(threads);
        const auto filtered = makeBrickReconstruction(
            grid, {.filter = {2, 0.16}, .cacheBytes = cacheBytes, .mostlyRead = mostlyRead});
        const auto spline = makeSplineReconstruction(grid, cacheBytes, mostlyRead);
        std::vector<double> values(2 * kTasks * kPlaces);
        parallelFor(kTasks, [&](std::int64_t task) {
            std::mt19937 random(static_cast<unsigned>(task));
            std::uniform_real_distribution<double> place(-60, 60);
            const auto probe = filtered->probe(), splineProbe = spline->probe();
            for (int i = 0; i < kPlaces; ++i) {
                const Vec3d x(place(random), place(random), place(random));
                const DensityAt at = probe->evaluate(x);
                values[2 * (task * kPlaces + i)] = at.value + at.gradient[task % 3];
                values[2 * (task * kPlaces + i) + 1] = splineProbe->value(x);
            }
        });
        return values;
    };
    constexpr std::size_t kRoom = std::size_t(512) << 20;
    const std::vector<double> expected = readAll(std::nullopt, 1, kRoom);
    EXPECT_EQ(readAll(kBand, 1, kRoom), expected);
    EXPECT_EQ(readAll(kBand, 4, kRoom), expected);
    EXPECT_EQ(readAll(kBand, 4, 0), expected);
    // No node at all is in such a band.
    EXPECT_EQ(readAll(DensityBand{2, 3}, 2, kRoom), expected);
}

}  // namespace
}  // namespace bandvox

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;

TEST(DetailLevels, AreWhatTheSourceWouldBecome) {
    DensityOptions options;
    options.voxelSize = 0.02;
    options.tolerance = 2e-5;
    const auto boundary = makeShapeBoundary("shape:two-balls");
    const auto base = surfaceToDensity(*boundary, options);
    const auto levels = makeDetailLevels(base.grid, 4);
    ASSERT_EQ(levels.size(), 4U);
    for (int l = 1; l <= 4; ++l) {
        const FloatGrid& level = *levels[l - 1];
        EXPECT_EQ(level.getName(), "density_level_" + std::to_string(l));
        EXPECT_EQ(level.metaValue<std::int64_t>("MultiResGrid_Level"), l);
        EXPECT_NEAR(level.voxelSize().x(), 0.02 * (1 << l), 1e-12);
        EXPECT_EQ(level.indexToWorld(Coord(0)), Vec3d(0.0));
        options.voxelSize = 0.02 * (1 << l);
        const auto expected = surfaceToDensity(*boundary, options);
        auto found = level.getConstAccessor();
        double worst = 0;
        for (auto it = expected.grid->cbeginValueOn(); it; ++it) {
            if (it.isVoxelValue()) {
                worst = std::max<double>(worst, std::abs(*it - found.getValue(it.getCoord())));
            }
        }
        EXPECT_LE(worst, 3e-4) << l;
        EXPECT_NEAR(densityIntegral(level), base.metadata.gridVolume,
                    5e-4 * base.metadata.gridVolume);
    }
}

// A zone plate: waves whose frequency rises with the distance from the middle. Beyond what a level
// holds, nothing may be left of them.
TEST(DetailLevels, HoldNoAliasesOfAZonePlate) {
    constexpr int kHalf = 96;
    constexpr double kFlat = 80;  // towards its rim the plate fades, so that the rim is no edge
    constexpr double kChirp = 0.5 / kHalf;  // the phase is π·kChirp·r², so k = kChirp·r
    auto grid = FloatGrid::create(0.0F);
    auto accessor = grid->getAccessor();
    for (int x = -kHalf; x <= kHalf; ++x) {
        for (int y = -kHalf; y <= kHalf; ++y) {
            const double r = std::hypot(x, y);
            const double rim = std::clamp((r - kFlat) / (kHalf - kFlat), 0.0, 1.0);
            const double wave = (0.5 + 0.5 * std::cos(std::numbers::pi * rim)) *
                                std::cos(std::numbers::pi * kChirp * r * r);
            for (int z = -8; z <= 8; ++z) {
                accessor.setValue(Coord(x, y, z), static_cast<float>(wave));
            }
        }
    }
    for (const ExponentialFilter& filter :
         {ExponentialFilter{2, 0.16}, ExponentialFilter{8, 0.35}}) {
        ResampleOptions options;
        options.filter = filter;
        const auto levels = makeDetailLevels(grid, 2, options);
        for (int l = 1; l <= 2; ++l) {
            // Where the waves are above the level's Nyquist by more than the chirp spreads,
            // which is about the root of its rate.
            double energy = 0;
            int count = 0;
            const int size = 1 << l;
            const double above = (0.5 / size + 2 * std::sqrt(kChirp)) / kChirp;
            auto found = levels[l - 1]->getConstAccessor();
            for (int x = -kHalf / size; x <= kHalf / size; ++x) {
                for (int y = -kHalf / size; y <= kHalf / size; ++y) {
                    const double r = size * std::hypot(x, y);
                    if (r < above || r > kFlat) continue;
                    energy += std::pow(found.getValue(Coord(x, y, 0)), 2);
                    ++count;
                }
            }
            ASSERT_GT(count, 100);
            // The plate's faces, above and below, leave 8 voxels of it in the middle: of its full
            // amplitude, -40 dB.
            EXPECT_LE(std::sqrt(energy / count), 0.01) << filter.order << ' ' << l;
        }
    }
}

TEST(DetailLevels, KeepTheInsideOfFogAsTiles) {
    auto fog = FloatGrid::create(0.0F);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->fill(openvdb::CoordBBox(Coord(-256), Coord(255)), 1.0F);
    const auto levels = makeDetailLevels(fog, 3);
    std::uint64_t before = 0;
    for (const auto& level : levels) {
        EXPECT_EQ(level->tree().getValue(Coord(0)), 1.0F);
        EXPECT_LT(level->tree().getValueDepth(Coord(0)), 3);
        EXPECT_EQ(level->getGridClass(), openvdb::GRID_FOG_VOLUME);
        // Leaves go with the surface.
        if (before > 0) {
            EXPECT_LT(3 * level->tree().leafCount(), before);
        }
        before = level->tree().leafCount();
    }
}

TEST(DetailLevels, RefuseNumbersThatAreNone) {
    const auto grid = FloatGrid::create(0.0F);
    EXPECT_THROW(makeDetailLevels(grid, 0), Error);
    EXPECT_THROW(makeDetailLevels(grid, 17), Error);
    EXPECT_THROW(makeDetailLevels(openvdb::FloatGrid::ConstPtr(), 1), Error);
}

}  // namespace
}  // namespace bandvox

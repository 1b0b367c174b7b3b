// The spectrum where it is known: of noise, of a wave, of what was filtered.

#include "grid/summary_grids.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>
#include <bandvox/source/shapes.h>
#include <bandvox/spectral/exponential_filter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using summary_grids::denseGrid;

constexpr int kNyquist = RadialSpectrum::kBlockSide / 2;

double decibels(double ratio) {
    return 10 * std::log10(ratio);
}

// Normal noise of variance `variance` in a cube.
std::vector<float> noise(int side, double variance) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal(0, static_cast<float>(std::sqrt(variance)));
    std::vector<float> values(static_cast<std::size_t>(side) * side * side);
    for (float& value : values) value = normal(random);
    return values;
}

// A cube of 9³ leaves: that in the middle of the tree's order lies in the middle of the cube, too,
// and the block around it inside.
constexpr int kWide = 72;

template <typename Value>
openvdb::FloatGrid::Ptr wideGrid(const Value& value) {
    return denseGrid(kWide, value);
}

TEST(RadialSpectrum, OfWhiteNoiseIsFlat) {
    constexpr double kVariance = 0.3;
    const std::vector<float> values = noise(kWide, kVariance);
    const auto grid =
        wideGrid([&](int x, int y, int z) { return values[(x * kWide + y) * kWide + z]; });
    const RadialSpectrum spectrum = radialSpectrum(*grid, 1);
    ASSERT_EQ(spectrum.power.size(), static_cast<std::size_t>(RadialSpectrum::kShells));
    EXPECT_EQ(spectrum.blocks, 1);
    // Shells at both ends have few frequencies, whose mean is a matter of chance.
    double sum = 0;
    for (int shell = 4; shell <= 50; ++shell) {
        EXPECT_NEAR(decibels(spectrum.power[shell] / kVariance), 0, shell < 16 ? 1.5 : 0.5)
            << shell;
        if (shell >= 16) sum += spectrum.power[shell] / kVariance;
    }
    EXPECT_NEAR(sum / 35, 1, 0.02);
}

TEST(RadialSpectrum, OfAWavePeaksAtItsFrequency) {
    for (const int cycles : {5, 12, 20, 31}) {
        const double turn = 2 * std::numbers::pi * cycles / RadialSpectrum::kBlockSide;
        // In three directions, and one that is none of the axes.
        const double direction[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0, 0.8}};
        for (const auto& d : direction) {
            const auto grid = wideGrid([&](int x, int y, int z) {
                return 3 + std::cos(turn * (d[0] * x + d[1] * y + d[2] * z));
            });
            const RadialSpectrum spectrum = radialSpectrum(*grid, 1);
            // Shells grow as k², so that of the mean the shells before weigh more.
            const auto peak = std::max_element(spectrum.power.begin(), spectrum.power.end());
            EXPECT_NEAR(static_cast<double>(peak - spectrum.power.begin()), cycles, 1) << cycles;
            // Hann's window keeps the rest of the wave out of all shells but the next two.
            for (int shell = 0; shell < RadialSpectrum::kShells; ++shell) {
                if (std::abs(shell - cycles) < 4) continue;
                EXPECT_LT(decibels(spectrum.power[shell] / *peak), -35) << cycles << ' ' << shell;
            }
        }
    }
}

TEST(RadialSpectrum, OfFilteredNoiseIsItsFiltersSquare) {
    // H(k) = exp(-(k/c)²) is the transform of exp(-(πcx)²), axis by axis.
    constexpr double kCutoff = 0.16;
    constexpr int kReach = 8;
    std::vector<float> values = noise(kWide, 1);
    std::vector<double> kernel;
    double sum = 0;
    for (int x = -kReach; x <= kReach; ++x) {
        kernel.push_back(std::exp(-std::pow(std::numbers::pi * kCutoff * x, 2)));
        sum += kernel.back();
    }
    for (const int stride : {1, kWide, kWide * kWide}) {
        std::vector<float> next(values.size());
        for (int i = 0; i < static_cast<int>(values.size()); ++i) {
            const int place = i / stride % kWide;
            double value = 0;
            for (int x = -kReach; x <= kReach; ++x) {
                const int other = (place + x + kWide) % kWide;
                value += kernel[x + kReach] / sum * values[i + (other - place) * stride];
            }
            next[i] = static_cast<float>(value);
        }
        values = next;
    }
    const auto grid =
        wideGrid([&](int x, int y, int z) { return values[(x * kWide + y) * kWide + z]; });
    const RadialSpectrum spectrum = radialSpectrum(*grid, 1);
    const ExponentialFilter filter{2, kCutoff};
    for (int shell = 4; shell <= kNyquist - 4; ++shell) {
        const double h = filter(RadialSpectrum::frequency(shell));
        EXPECT_NEAR(decibels(spectrum.power[shell] / (h * h)), 0, shell < 8 ? 2 : 1) << shell;
    }
}

TEST(RadialSpectrum, OfADensityFallsAsItsFilterSays) {
    // The same ball under two filters: what differs is the square of what the filters pass.
    const auto ball = makeShapeBoundary("shape:sphere");
    const auto spectrumWith = [&](double cutoff) {
        DensityOptions options;
        options.resolution = 32;
        options.filter = {2, cutoff};
        options.tolerance = 1e-6;
        return radialSpectrum(*surfaceToDensity(*ball, options).grid, 10000);
    };
    const RadialSpectrum wide = spectrumWith(0.14), narrow = spectrumWith(0.12);
    for (int shell = 3; shell <= 18; ++shell) {
        const double k = RadialSpectrum::frequency(shell);
        const double passed = ExponentialFilter{2, 0.14}(k) / ExponentialFilter{2, 0.12}(k);
        EXPECT_NEAR(decibels(wide.power[shell] / narrow.power[shell]), decibels(passed * passed),
                    1.5)
            << shell;
    }
    // Nothing is left at Nyquist: 80 dB less than at a tenth of it.
    EXPECT_LT(decibels(narrow.power[kNyquist] / narrow.power[3]), -80);
}

TEST(RadialSpectrum, ChoosesAsManyBlocksAsItMay) {
    const auto grid = summary_grids::mixedGrid();
    const int leaves = static_cast<int>(grid->tree().leafCount());
    EXPECT_EQ(radialSpectrum(*grid, 3).blocks, 3);
    EXPECT_EQ(radialSpectrum(*grid, 100000).blocks, leaves);
}

TEST(RadialSpectrum, OfTilesAloneThereIsNone) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().addTile(1, Coord(0), 1.0F, true);
    EXPECT_EQ(radialSpectrum(*grid).blocks, 0);
    EXPECT_TRUE(radialSpectrum(*grid).power.empty());
}

TEST(RadialSpectrum, IsTheSameForAnyNumberOfThreads) {
    const auto grid = summary_grids::mixedGrid();
    const std::vector<double> many = radialSpectrum(*grid, 20).power;
    const ThreadLimit one(1);
    EXPECT_EQ(radialSpectrum(*grid, 20).power, many);
}

TEST(RadialSpectrum, RefusesWhatItCannotDo) {
    const auto kindOf = [](const openvdb::FloatGrid& grid, int blocks, Progress& progress) {
        try {
            radialSpectrum(grid, blocks, progress);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << "nothing was thrown";
        return ErrorKind::Runtime;
    };
    struct Stopped : Progress {
        bool interrupted() const override { return true; }
    } stopped;
    EXPECT_EQ(kindOf(*summary_grids::mixedGrid(), 0, silentProgress()), ErrorKind::Usage);
    EXPECT_EQ(kindOf(*openvdb::FloatGrid::create(), 1, silentProgress()), ErrorKind::Result);
    EXPECT_EQ(kindOf(*summary_grids::mixedGrid(), 1, stopped), ErrorKind::Interrupted);
}

}  // namespace
}  // namespace bandvox

#include "reconstruct/random_lattice.h"

#include <bandvox/core/parallel.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using reconstruct_test::RandomLattice;

constexpr double kDegree = std::numbers::pi / 180;

struct Case {
    ExponentialFilter filter;
    double mean;
};

class EachSpectrum : public testing::TestWithParam<Case> {};

// What the default options promise, for the hardest of densities: all frequencies that the filter
// leaves, with phases that nothing ties to each other.
TEST_P(EachSpectrum, IsReadByDefaultAsTheDirectSumOfItsWaves) {
    constexpr int kPlaces = 800, kHalo = 40;
    const RandomLattice truth(GetParam().filter, GetParam().mean, 5);
    BrickReconstructionOptions options;
    options.filter = GetParam().filter;
    const auto reconstruction = makeBrickReconstruction(truth.grid(kHalo), options);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(0, RandomLattice::kPeriod);
    std::vector<Vec3d> places;
    for (int i = 0; i < kPlaces; ++i) {
        places.emplace_back(uniform(random), uniform(random), uniform(random));
    }
    std::vector<DensityExpansion> expected(kPlaces);
    parallelFor(kPlaces, [&](std::int64_t i) { expected[i] = truth(places[i]); });
    double steepest = 0;
    for (const DensityExpansion& at : expected) {
        steepest = std::max(steepest, at.gradient.length());
    }
    const auto probe = reconstruction->probe();
    double value = 0, angle = 0, gradient = 0;
    int steep = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const DensityAt found = probe->evaluate(places[i]);
        const Vec3d &e = expected[i].gradient, &f = found.gradient;
        value = std::max(value, std::abs(found.value - expected[i].value));
        gradient = std::max(gradient, (e - f).length() / steepest);
        if (!(e.length() > 0.05 * steepest)) continue;
        ++steep;
        angle = std::max(angle, std::atan2(e.cross(f).length(), e.dot(f)));
    }
    EXPECT_LE(value, 1e-4);
    EXPECT_LE(angle, 0.05 * kDegree);
    EXPECT_GT(steep, kPlaces / 2);
    RecordProperty("value", std::to_string(value));
    RecordProperty("degrees", std::to_string(angle / kDegree));
    RecordProperty("gradient", std::to_string(gradient));
}

INSTANTIATE_TEST_SUITE_P(Spectra, EachSpectrum,
                         testing::Values(Case{{2, 0.16}, 0}, Case{{2, 0.16}, 0.5},
                                         Case{{4, 0.2}, 0}, Case{{4, 0.2}, 0.5}, Case{{4, 0.25}, 0},
                                         Case{{8, 0.35}, 0}, Case{{8, 0.35}, 0.5}));

}  // namespace
}  // namespace bandvox

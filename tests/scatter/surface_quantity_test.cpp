#include <bandvox/core/error.h>
#include <bandvox/scatter/surface_quantity.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace bandvox {
namespace {

BsplineSurface randomSurface() {
    BsplineSurface surface({-1, 2, 3, 5}, {5, 4}, 2);
    std::mt19937 generator(3);
    for (int column = 0; column < 2; ++column) {
        for (double& control : surface.control(column)) control = generator() / 4294967296.0;
    }
    return surface;
}

std::vector<double> expectedAt(const SurfaceJet& jet, SurfaceQuantity quantity) {
    switch (quantity) {
        case SurfaceQuantity::Value:
            return {jet.value};
        case SurfaceQuantity::Dx:
            return {jet.dx};
        case SurfaceQuantity::Dy:
            return {jet.dy};
        case SurfaceQuantity::Dxx:
            return {jet.dxx};
        case SurfaceQuantity::Dxy:
            return {jet.dxy};
        case SurfaceQuantity::Dyy:
            return {jet.dyy};
        case SurfaceQuantity::Normal: {
            const auto normal = jet.normal();
            return {normal.begin(), normal.end()};
        }
        case SurfaceQuantity::GaussianCurvature:
            return {jet.gaussianCurvature()};
        case SurfaceQuantity::MeanCurvature:
            return {jet.meanCurvature()};
    }
    return {};
}

TEST(SurfaceQuantity, IsOnGridsWhatItIsAtPoints) {
    const BsplineSurface surface = randomSurface();
    constexpr std::array<int, 2> kSamples{17, 12};
    for (const SurfaceQuantity quantity : surfaceQuantities()) {
        const auto numbers = sampleQuantity(surface, kSamples, 1, quantity);
        ASSERT_EQ(numbers.size(), static_cast<std::size_t>(numbersOf(quantity)));
        for (int i = 0; i < kSamples[0]; ++i) {
            for (int j = 0; j < kSamples[1]; ++j) {
                const SurfaceJet jet = surface.jet(-1 + 4 * i / 16.0, 2 + 3 * j / 11.0, 1);
                const std::vector<double> expected = expectedAt(jet, quantity);
                ASSERT_EQ(expected.size(), numbers.size());
                for (std::size_t n = 0; n < numbers.size(); ++n) {
                    const double found = numbers[n][static_cast<std::size_t>(i * 12 + j)];
                    EXPECT_NEAR(found, expected[n], 1e-11 * (1 + std::abs(expected[n])))
                        << nameOf(quantity);
                }
            }
        }
    }
}

TEST(SurfaceQuantity, HasAName) {
    EXPECT_EQ(surfaceQuantities().size(), 9U);
    for (const SurfaceQuantity quantity : surfaceQuantities()) {
        EXPECT_EQ(surfaceQuantityNamed(nameOf(quantity)), quantity);
    }
    EXPECT_FALSE(surfaceQuantityNamed("torsion"));
    EXPECT_FALSE(surfaceQuantityNamed(""));
}

TEST(SurfaceQuantity, RefusesColumnsThatAreNotThere) {
    EXPECT_THROW(sampleQuantity(randomSurface(), {5, 5}, 2, SurfaceQuantity::Normal), Error);
    EXPECT_THROW(sampleQuantity(randomSurface(), {5, 1}, 0, SurfaceQuantity::Dxx), Error);
}

}  // namespace
}  // namespace bandvox

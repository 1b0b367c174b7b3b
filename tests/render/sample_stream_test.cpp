#include "render/sample_stream.h"

#include "render/filter_places.h"
#include "render/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec2d;

TEST(SampleStream, OfAPixelIsStratified) {
    for (const int count : {4, 16, 64, 256}) {
        for (std::uint32_t pixel = 0; pixel < 40; ++pixel) {
            // In each pair, each dimension alone, and for an even power of two squares too.
            for (int pair = 0; pair < 3; ++pair) {
                std::vector<int> first(count), second(count), squares(count);
                const int side = static_cast<int>(std::sqrt(count));
                for (int s = 0; s < count; ++s) {
                    SampleStream numbers(7, pixel, 3 * pixel, s);
                    Vec2d u;
                    for (int i = 0; i <= pair; ++i) u = numbers.next2();
                    for (int i = 0; i < 2; ++i) ASSERT_TRUE(u[i] >= 0 && u[i] < 1);
                    ++first[static_cast<int>(u[0] * count)];
                    ++second[static_cast<int>(u[1] * count)];
                    ++squares[static_cast<int>(u[0] * side) * side + static_cast<int>(u[1] * side)];
                }
                const std::vector<int> once(count, 1);
                ASSERT_EQ(first, once) << count << " " << pixel << " " << pair;
                ASSERT_EQ(second, once) << count << " " << pixel << " " << pair;
                ASSERT_EQ(squares, once) << count << " " << pixel << " " << pair;
            }
        }
    }
}

TEST(SampleStream, DependsOnItsSeedPixelAndSampleAlone) {
    std::set<double> seen;
    for (const std::uint32_t seed : {0u, 1u, 0xFFFFFFFFu}) {
        for (const std::uint32_t column : {0u, 1u, 65535u}) {
            for (const std::uint32_t row : {0u, 1u, 65535u}) {
                for (const std::uint32_t sample : {0u, 1u, 4095u}) {
                    SampleStream one(seed, column, row, sample), other(seed, column, row, sample);
                    for (int i = 0; i < 4; ++i) {
                        const double u = one.next();
                        EXPECT_EQ(u, other.next());
                        EXPECT_TRUE(seen.insert(u).second);
                    }
                }
            }
        }
    }
}

TEST(SampleStream, BranchesAreIndependent) {
    double product = 0, own = 0;
    std::set<double> seen;
    constexpr int kPixels = 20000;
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        SampleStream numbers(1, pixel, 0, 0);
        SampleStream left = numbers.branch(0), right = numbers.branch(1);
        const double a = left.next() - 0.5, b = right.next() - 0.5, c = numbers.next() - 0.5;
        SampleStream later = numbers.branch(0);
        EXPECT_NE(later.next() - 0.5, a);
        product += a * b / kPixels;
        own += a * c / kPixels;
    }
    // Of independent numbers 0 within four standard errors, 1/12 / √n.
    EXPECT_NEAR(product, 0, 4 / 12.0 / std::sqrt(kPixels));
    EXPECT_NEAR(own, 0, 4 / 12.0 / std::sqrt(kPixels));
}

double weightOf(PixelFilter filter, double x) {
    using std::numbers::pi;
    switch (filter) {
        case PixelFilter::Box:
            return std::abs(x) <= 0.5 ? 1 : 0;
        case PixelFilter::Triangle:
            return std::max(1 - std::abs(x), 0.0);
        case PixelFilter::Gaussian:
            return std::abs(x) < 1.5 ? std::exp(-2 * x * x) - std::exp(-4.5) : 0;
        case PixelFilter::BlackmanHarris: {
            if (std::abs(x) > 2) return 0;
            const double t = 0.5 * pi * x;
            return 0.35875 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) +
                   0.01168 * std::cos(3 * t);
        }
    }
    return 0;
}

class EachPixelFilter : public testing::TestWithParam<PixelFilter> {};

TEST_P(EachPixelFilter, IsDrawnByItsWeight) {
    const FilterPlaces places(GetParam());
    constexpr int kSteps = 100000;
    double found[4] = {}, expected[4] = {}, total = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = -2.5 + 5 * (i + 0.5) / kSteps, weight = weightOf(GetParam(), x);
        total += weight;
        const double place = places((i + 0.5) / kSteps) - 0.5;
        for (int m = 0; m < 4; ++m) {
            expected[m] += weight * std::pow(x, m + 1);
            found[m] += std::pow(place, m + 1) / kSteps;
        }
    }
    for (int m = 0; m < 4; ++m) EXPECT_NEAR(found[m], expected[m] / total, 1e-4) << m;
}

TEST_P(EachPixelFilter, IsSymmetricAndRisesAndEnds) {
    const FilterPlaces places(GetParam());
    const double radius = filterRadius(GetParam());
    double before = 0.5 - radius;
    for (double u = 0; u < 1; u += 1.0 / 997) {
        const double place = places(u);
        EXPECT_NEAR(place + places(1 - u), 1, 1e-3 + (u == 0 ? radius : 0));
        EXPECT_GE(place, before);
        EXPECT_LE(place, 0.5 + radius);
        before = place;
    }
    EXPECT_NEAR(places(0.5), 0.5, 1e-9);
}

TEST_P(EachPixelFilter, PutsSamplesAround) {
    for (const int samples : {1, 2, 5, 16, 31}) {
        const auto places = samplePlaces(samples, GetParam());
        EXPECT_EQ(static_cast<int>(places.size()), samples);
        for (const Vec2d& place : places) {
            for (int i = 0; i < 2; ++i) {
                EXPECT_LE(std::abs(place[i] - 0.5), filterRadius(GetParam()));
            }
        }
    }
    const auto alone = samplePlaces(1, GetParam());
    EXPECT_NEAR(alone[0][0], 0.5, 1e-9);
    EXPECT_NEAR(alone[0][1], 0.5, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Filters, EachPixelFilter,
                         testing::Values(PixelFilter::Box, PixelFilter::Triangle,
                                         PixelFilter::Gaussian, PixelFilter::BlackmanHarris));

}  // namespace
}  // namespace bandvox

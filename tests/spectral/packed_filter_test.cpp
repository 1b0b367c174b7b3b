#include "spectral/packed_filter.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using Complex = std::complex<double>;

// What a frequency becomes, which is -n/2 < x, y, z ≤ n/2.
using Response = std::function<Complex(int x, int y, int z)>;

// The filter by its definition: of n³ samples, Σ_x f(x) h(y - x), where h is the sum of all
// frequencies.
std::vector<double> filterDirectly(const std::vector<double>& samples, int n,
                                   const Response& response) {
    const auto index = [n](int x, int y, int z) { return (x * n + y) * n + z; };
    const auto signedOf = [n](int i) { return i <= n / 2 ? i : i - n; };
    std::vector<Complex> turns(n);
    for (int i = 0; i < n; ++i) turns[i] = std::polar(1.0, 2 * std::numbers::pi * i / n);
    std::vector<double> taps(samples.size());
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                Complex sum = 0;
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; j < n; ++j) {
                        for (int k = 0; k < n; ++k) {
                            sum += response(signedOf(i), signedOf(j), signedOf(k)) *
                                   turns[(i * x + j * y + k * z) % n];
                        }
                    }
                }
                taps[index(x, y, z)] = sum.real() / (n * n * n);
            }
        }
    }
    std::vector<double> filtered(samples.size());
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                double sum = 0;
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; j < n; ++j) {
                        for (int k = 0; k < n; ++k) {
                            sum += samples[index(i, j, k)] *
                                   taps[index((x - i + n) % n, (y - j + n) % n, (z - k + n) % n)];
                        }
                    }
                }
                filtered[index(x, y, z)] = sum;
            }
        }
    }
    return filtered;
}

const RealFft3& packedFft(int n) {
    return RealFft3::get(n, 3, 5, 0, SpectrumLayout::Packed);
}

// Filters random samples both ways, in a buffer with a margin, and holds one to the other.
void expectSameAsDirect(int n, const PackedFilter& filter, const Response& response) {
    const RealFft3& fft = packedFft(n);
    const FftBuffer buffer = fft.allocate();
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<double> samples;
    const auto at = [&](int x, int y) { return (x * fft.yCount() + y) * fft.zStride(); };
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                samples.push_back(buffer[at(x, y) + z] = uniform(random));
            }
        }
    }
    const std::vector<double> expected = filterDirectly(samples, n, response);
    fft.forward(buffer.get());
    filter.multiply(buffer.get());
    fft.inverse(buffer.get());
    const double scale = 2.0 / (n * n * n);
    for (int x = 0, i = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z, ++i) {
                ASSERT_NEAR(scale * buffer[at(x, y) + z], expected[i], 2e-6)
                    << n << ": " << x << " " << y << " " << z;
            }
        }
    }
}

class PackedFilterOfSize : public testing::TestWithParam<int> {};

TEST_P(PackedFilterOfSize, WithoutAnEffectLeavesAllAsItWas) {
    const int n = GetParam();
    const auto one = [](int, int, int) { return 1.0; };
    expectSameAsDirect(n, PackedFilter(packedFft(n), one, true), one);
    expectSameAsDirect(n, PackedFilter(packedFft(n), one, false), one);
}

TEST_P(PackedFilterOfSize, OfMagnitudesAndAFactorAlongXEqualsTheDirectSum) {
    const int n = GetParam();
    const auto transfer = [n](int x, int y, int z) {
        return std::exp(-(x * x + 2.0 * y * y + 0.5 * z * z) / (n * n)) + 0.1 * std::abs(z);
    };
    // At n/2 a factor has to be real.
    std::vector<std::complex<float>> factors;
    const auto factor = [n](int x) { return Complex(1 + std::abs(x), 2 * x == n ? 0 : 0.3 * x); };
    for (int i = 0; i < n; ++i) factors.emplace_back(factor(i <= n / 2 ? i : i - n));
    expectSameAsDirect(n, PackedFilter(packedFft(n), transfer, true, factors),
                       [&](int x, int y, int z) {
                           return factor(x) * transfer(std::abs(x), std::abs(y), std::abs(z));
                       });
}

// T(k) = T(-k), but not T(x, y, z) = T(-x, y, z).
TEST_P(PackedFilterOfSize, OfASlantedTransferEqualsTheDirectSum) {
    const int n = GetParam();
    const auto transfer = [](int x, int y, int z) {
        return std::cos(0.7 * x + 0.4 * y - 1.1 * z) + 0.2 * x * z;
    };
    // At n/2 both signs are as good.
    const auto turned = [n](int i) { return 2 * std::abs(i) == n ? -i : i; };
    expectSameAsDirect(n, PackedFilter(packedFft(n), transfer, false), [&](int x, int y, int z) {
        return 0.5 * (transfer(x, y, z) + transfer(turned(x), turned(y), turned(z)));
    });
}

INSTANTIATE_TEST_SUITE_P(Sizes, PackedFilterOfSize, testing::Values(2, 4, 6, 8, 10));

TEST(PackedFilter, RefusesAnotherLayout) {
    const auto one = [](int, int, int) { return 1.0; };
    EXPECT_THROW(PackedFilter(RealFft3::get(8), one, true), Error);
}

}  // namespace
}  // namespace bandvox

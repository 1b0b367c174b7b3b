#include "spectral/fft.h"

#include "spectral/complex_fft.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using Complex = std::complex<double>;

// One axis of a discrete transform by its definition.
void transformAxis(std::vector<Complex>& data, int n, int stride, int sign) {
    std::vector<Complex> line(n);
    for (int start = 0; start < n * n * n; ++start) {
        if (start / stride % n != 0) continue;
        for (int k = 0; k < n; ++k) {
            line[k] = 0;
            for (int x = 0; x < n; ++x) {
                const double angle = sign * 2 * std::numbers::pi * (k * x % n) / n;
                line[k] += data[start + x * stride] * std::polar(1.0, angle);
            }
        }
        for (int k = 0; k < n; ++k) data[start + k * stride] = line[k];
    }
}

class RealFft3OfSize : public testing::TestWithParam<int> {};

TEST_P(RealFft3OfSize, EqualsTheDirectSum) {
    const int n = GetParam();
    const RealFft3& fft = RealFft3::get(n, 3, 9);
    const FftBuffer buffer = fft.allocate();
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Complex> truth(n * n * n);
    const auto at = [&](int x, int y) { return (x * fft.yCount() + y) * fft.zStride(); };
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                const float value = uniform(random);
                buffer[at(x, y) + z] = value;
                truth[(x * n + y) * n + z] = value;
            }
        }
    }
    const std::vector<Complex> samples = truth;
    for (const int stride : {1, n, n * n}) transformAxis(truth, n, stride, -1);

    fft.forward(buffer.get());
    const double rounding = 2e-6 * n * std::sqrt(n);
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z <= n / 2; ++z) {
                const float* value = buffer.get() + at(x, y) + 2 * z;
                const Complex expected = truth[(x * n + y) * n + z];
                ASSERT_NEAR(value[0], expected.real(), rounding);
                ASSERT_NEAR(value[1], expected.imag(), rounding);
            }
        }
    }
    fft.inverse(buffer.get());
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) {
            for (int z = 0; z < n; ++z) {
                ASSERT_NEAR(buffer[at(x, y) + z] / (n * n * n), samples[(x * n + y) * n + z].real(),
                            1e-5);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RealFft3OfSize, testing::Values(4, 6, 10, 12, 14, 16, 20));

TEST(RealFft3, InverseOfTheInnerPartIsThatPart) {
    constexpr int kSize = 16, kInner = 5, kFirst = 4;
    for (const SpectrumLayout layout : {SpectrumLayout::Half, SpectrumLayout::Packed}) {
        const RealFft3& whole = RealFft3::get(kSize, 0, 0, 0, layout);
        const RealFft3& part = RealFft3::get(kSize, 0, 0, kInner, layout);
        const FftBuffer a = whole.allocate();
        const FftBuffer b = part.allocate();
        for (std::size_t i = 0; i < whole.bufferSize(); ++i) a[i] = std::sin(0.37F * i * i);
        std::copy_n(a.get(), whole.bufferSize(), b.get());
        whole.forward(a.get());
        whole.inverse(a.get());
        part.forward(b.get());
        part.inverse(b.get(), kFirst);
        for (int x = kFirst; x < kFirst + kInner; ++x) {
            for (int y = kFirst; y < kFirst + kInner; ++y) {
                for (int z = 0; z < kSize; ++z) {
                    const int index = (x * whole.yCount() + y) * whole.zStride() + z;
                    EXPECT_NEAR(a[index], b[index], 1e-2) << x << " " << y << " " << z;
                }
            }
        }
    }
}

TEST(RealFft3, PlansOfOneShapeAreShared) {
    EXPECT_EQ(&RealFft3::get(24), &RealFft3::get(24));
    EXPECT_NE(&RealFft3::get(24), &RealFft3::get(24, 1));
}

TEST(RealFft3, WithoutAPlanThereIsAnError) {
    // Sizes that nothing is planned for. The second call must not find what the first has left.
    for (int i = 0; i < 2; ++i) {
        EXPECT_THROW(RealFft3::get(0), Error);
        EXPECT_THROW(RealFft3::get(9), Error);
    }
}

TEST(ComplexFft, WithoutAPlanThereIsAnError) {
    for (int i = 0; i < 2; ++i) {
        EXPECT_THROW(ComplexFft<double>::get(0, 1, FftDirection::Forward, {}, {}), Error);
        EXPECT_THROW(ComplexFft<float>::get(0, 1, FftDirection::Forward, {}, {}), Error);
    }
}

}  // namespace
}  // namespace bandvox

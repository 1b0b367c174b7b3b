#include <bandvox/core/error.h>
#include <bandvox/spectral/pruned_transform.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace bandvox {
namespace {

constexpr int kBatch = 3;
constexpr std::ptrdiff_t kStride = 5;  // more than the batch: the rest must not be touched

template <typename Real>
class PrunedTransform : public testing::Test {
  public:
    std::vector<std::complex<Real>> randomSignals(int points) {
        std::vector<std::complex<Real>> signals(points * kStride);
        std::uniform_real_distribution<Real> uniform(-1, 1);
        for (auto& value : signals) value = {uniform(mRandom), uniform(mRandom)};
        return signals;
    }

    // Rounding of a sum of `terms` numbers of about 1.
    static double rounding(int terms) {
        return 4 * std::numeric_limits<Real>::epsilon() * std::sqrt(double(terms)) *
               std::log2(terms + 2.0);
    }

    std::vector<std::complex<Real>> mScratch;
    std::mt19937 mRandom{11};
};

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PrunedTransform, Precisions);

std::complex<double> wave(double turns) {
    return std::polar(1.0, 2 * std::numbers::pi * turns);
}

// F(k) of one signal of a batch, by its definition.
template <typename Complex>
std::complex<double> directFrequency(const std::vector<Complex>& signals, int samples, int signal,
                                     int k) {
    std::complex<double> sum = 0;
    for (int j = 0; j < samples; ++j) {
        sum += std::complex<double>(signals[j * kStride + signal]) *
               wave(-double(std::int64_t(j) * k % samples) / samples);
    }
    return sum;
}

// f(place) of one spectrum of a batch, M = LN places, by its definition.
template <typename Complex>
std::complex<double> directPlace(const std::vector<Complex>& spectra, int n, int places, int signal,
                                 int place) {
    std::complex<double> sum = 0;
    for (int k = 0; k < n; ++k) {
        const std::int64_t turns = std::int64_t(signedFrequency(k, n)) * place % places;
        sum += std::complex<double>(spectra[k * kStride + signal]) * wave(double(turns) / places);
    }
    return sum / double(n);
}

struct Size {
    int n, factor;  // N, and R/N or L
};
const Size kSizes[] = {{1, 1}, {1, 7}, {2, 1}, {2, 5},  {3, 4},  {4, 4},  {5, 3},
                       {6, 8}, {8, 8}, {9, 2}, {12, 5}, {15, 7}, {16, 4}, {32, 16}};

TYPED_TEST(PrunedTransform, LowFrequenciesEqualTheDirectSum) {
    using Complex = std::complex<TypeParam>;
    for (const auto& [n, factor] : kSizes) {
        const int samples = n * factor;
        const auto signals = this->randomSignals(samples);
        std::vector<Complex> spectra(n * kStride, Complex(77));
        LowFrequencyTransform<TypeParam>(samples, n)(
            {signals.data(), kStride}, {spectra.data(), kStride}, kBatch, this->mScratch);
        for (int k = 0; k < n; ++k) {
            for (int b = 0; b < kBatch; ++b) {
                const auto truth = directFrequency(signals, samples, b, signedFrequency(k, n));
                EXPECT_LE(std::abs(std::complex<double>(spectra[k * kStride + b]) - truth),
                          this->rounding(samples) * std::sqrt(samples))
                    << "R " << samples << ", N " << n << ", k " << k;
            }
            EXPECT_EQ(spectra[k * kStride + kBatch], Complex(77));
        }
    }
}

TYPED_TEST(PrunedTransform, PairsOfRealSignalsEqualTheDirectSum) {
    using Complex = std::complex<TypeParam>;
    for (const auto& [n, factor] : kSizes) {
        const int samples = n * factor;
        auto signals = this->randomSignals(samples);
        std::vector<TypeParam> real[2];
        for (int j = 0; j < samples; ++j) {
            for (int b = 0; b < 2; ++b) {
                real[b].push_back(signals[j * kStride + b].real());
                signals[j * kStride + b] = real[b].back();
            }
        }
        std::vector<Complex> spectra[2] = {std::vector<Complex>(n / 2 + 1),
                                           std::vector<Complex>(n / 2 + 1)};
        LowFrequencyTransform<TypeParam>(samples, n)
            .pair(real[0].data(), real[1].data(), spectra[0].data(), spectra[1].data(),
                  this->mScratch);
        for (int b = 0; b < 2; ++b) {
            for (int k = 0; 2 * k <= n; ++k) {
                const auto truth = directFrequency(signals, samples, b, signedFrequency(k, n));
                EXPECT_LE(std::abs(std::complex<double>(spectra[b][k]) - truth),
                          this->rounding(samples) * std::sqrt(samples))
                    << "R " << samples << ", N " << n << ", k " << k << ", signal " << b;
            }
        }
    }
}

TYPED_TEST(PrunedTransform, PhasesEqualTheDirectSum) {
    using Complex = std::complex<TypeParam>;
    for (const auto& [n, factor] : kSizes) {
        const PhaseTransform<TypeParam> phases(n, factor);
        const auto spectra = this->randomSignals(n);
        for (int s = 0; s < factor; ++s) {
            std::vector<Complex> values(n * kStride, Complex(77));
            phases(s, {spectra.data(), kStride}, {values.data(), kStride}, kBatch, this->mScratch);
            for (int r = 0; r < n; ++r) {
                for (int b = 0; b < kBatch; ++b) {
                    const auto truth = directPlace(spectra, n, n * factor, b, s + r * factor);
                    EXPECT_LE(std::abs(std::complex<double>(values[r * kStride + b]) - truth),
                              this->rounding(n))
                        << "N " << n << ", L " << factor << ", place " << s + r * factor;
                }
                EXPECT_EQ(values[r * kStride + kBatch], Complex(77));
            }
        }
    }
}

TYPED_TEST(PrunedTransform, SubsetsAreTheSamePlaces) {
    using Complex = std::complex<TypeParam>;
    for (const auto& [n, factor] : kSizes) {
        const PhaseTransform<TypeParam> phases(n, factor);
        const SubsetTransform<TypeParam> subset(phases);
        const auto spectra = this->randomSignals(n);
        const int s = factor / 2;
        for (int wanted = 0; wanted <= n; ++wanted) {
            // Places in no order, not next to each other.
            std::vector<int> places(n);
            for (int r = 0; r < n; ++r) places[r] = r;
            std::shuffle(places.begin(), places.end(), this->mRandom);
            places.resize(wanted);
            std::vector<Complex> values(n * kStride, Complex(77));
            subset(s, places, {spectra.data(), kStride}, {values.data(), kStride}, kBatch,
                   this->mScratch);
            for (int i = 0; i < wanted; ++i) {
                const auto truth = directPlace(spectra, n, n * factor, 1, s + places[i] * factor);
                EXPECT_LE(std::abs(std::complex<double>(values[i * kStride + 1]) - truth),
                          this->rounding(n))
                    << "N " << n << ", L " << factor << ", place " << places[i];
                EXPECT_EQ(values[i * kStride + kBatch], Complex(77));
            }
        }
    }
}

// Interpolating what was just reduced gives a band-limited signal back.
TYPED_TEST(PrunedTransform, PhasesUndoLowFrequencies) {
    using Complex = std::complex<TypeParam>;
    const int n = 12, factor = 5, samples = n * factor;
    std::vector<Complex> signal(samples);
    for (int j = 0; j < samples; ++j) {
        signal[j] = Complex(wave(3.0 * j / samples) + 0.5 * wave(-5.0 * j / samples) + 0.25);
    }
    std::vector<Complex> spectrum(n), values(n);
    LowFrequencyTransform<TypeParam>(samples, n)({signal.data(), 1}, {spectrum.data(), 1}, 1,
                                                 this->mScratch);
    const PhaseTransform<TypeParam> phases(n, factor);
    for (int s = 0; s < factor; ++s) {
        phases(s, {spectrum.data(), 1}, {values.data(), 1}, 1, this->mScratch);
        for (int r = 0; r < n; ++r) {
            EXPECT_LE(std::abs(values[r] / TypeParam(factor) - signal[s + r * factor]),
                      this->rounding(samples));
        }
    }
}

// The paper's numbers of multiplications. Where a factor is 1 ours are fewer: N of the R products
// in (a), none in (b) and (c).
TYPED_TEST(PrunedTransform, CountsAreThePapersFormulas) {
    using Complex = std::complex<TypeParam>;
    for (const auto& [n, factor] : {Size{8, 8}, Size{32, 16}, Size{12, 5}, Size{15, 3}}) {
        const int m = n * factor;  // R of (a), M of (b) and (c)
        const double logN = std::log2(n);
        const auto signals = this->randomSignals(m);
        std::vector<Complex> out(m * kStride);

        OperationCount low;
        LowFrequencyTransform<TypeParam>(m, n)({signals.data(), kStride}, {out.data(), kStride},
                                               kBatch, this->mScratch, &low);
        EXPECT_NEAR(low.multiplications, kBatch * (m * (1 + logN) - n), 1e-6 * m);

        const PhaseTransform<TypeParam> phases(n, factor);
        OperationCount all;
        for (int s = 0; s < factor; ++s) {
            phases(s, {signals.data(), kStride}, {out.data(), kStride}, kBatch, this->mScratch,
                   &all);
        }
        EXPECT_NEAR(all.multiplications, kBatch * m * (1 + logN), 1e-6 * m);

        // W places, W/L of them in each phase: M (1 + log(W/L)) + M - W.
        const SubsetTransform<TypeParam> subset(phases);
        for (int x = 1; x <= n; ++x) {
            if (n % x != 0) continue;
            const double w = double(x) * factor;
            std::vector<int> places;
            for (int i = 0; i < x; ++i) places.push_back((5 * i + 2) % n);
            OperationCount some;
            for (int s = 0; s < factor; ++s) {
                subset(s, places, {signals.data(), kStride}, {out.data(), kStride}, kBatch,
                       this->mScratch, &some);
            }
            const double paper = kBatch * (m * (1 + std::log2(w / factor)) + m - w);
            EXPECT_LE(some.multiplications, paper * (1 + 1e-9)) << "N " << n << ", W/L " << x;
            EXPECT_LE(some.multiplications, all.multiplications * (1 + 1e-9));
            // A better divisor than W/L may exist, but does not for powers of two beyond 4.
            if ((n & (n - 1)) == 0 && x >= 4) {
                EXPECT_NEAR(some.multiplications, paper, 1e-6 * paper);
            }
        }
    }
}

// Where W/L does not divide N, no transform belongs to the paper's formula. What
// docs/math/pruned-transforms.md says of how (c) compares with it:
TEST(PrunedTransformCounts, OfAnyNumberOfPlacesAgainstThePapers) {
    std::vector<std::complex<double>> scratch;
    const auto overPaper = [&scratch](int n, int wanted) {
        const PhaseTransform<double> phases(n, 1);
        const std::vector<std::complex<double>> spectrum(n);
        std::vector<std::complex<double>> values(wanted);
        std::vector<int> places(wanted);
        for (int i = 0; i < wanted; ++i) places[i] = i;
        OperationCount count;
        SubsetTransform<double> subset(phases);
        subset(0, places, {spectrum.data(), 1}, {values.data(), 1}, 1, scratch, &count);
        EXPECT_LE(count.multiplications, n * (1 + std::log2(n)) * (1 + 1e-9));  // that of (b)
        return count.multiplications / (n * (1 + std::log2(wanted)) + n - wanted);
    };
    for (const int n : {8, 12, 16, 32, 48, 64, 96, 128, 256}) {
        for (int wanted = 1; wanted <= n; ++wanted) {
            const double ratio = overPaper(n, wanted);
            EXPECT_LE(ratio, 1 + 1e-9) << "N " << n << ", W/L " << wanted;
            EXPECT_GE(ratio, 1 - 0.027) << "N " << n << ", W/L " << wanted;
        }
    }
    EXPECT_NEAR(overPaper(31, 5), 1.40, 0.005);
    EXPECT_NEAR(overPaper(254, 12), 1.44, 0.005);
    EXPECT_NEAR(overPaper(251, 8), 1.81, 0.005);
}

TEST(PrunedTransformSizes, WrongOnesAreRefusedWithTheirValues) {
    const auto expectRefused = [](const auto& make, const char* first, const char* second) {
        try {
            make();
            FAIL() << first << " and " << second << " were taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            EXPECT_NE(std::string(error.what()).find(first), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(second), std::string::npos) << error.what();
        }
    };
    expectRefused([] { LowFrequencyTransform<float>(16, 32); }, "16", "32");
    expectRefused([] { LowFrequencyTransform<float>(100, 32); }, "100", "32");
    expectRefused([] { LowFrequencyTransform<float>(16, 0); }, "16", "0");
    expectRefused([] { LowFrequencyTransform<float>(0, 0); }, "0", "0");
    expectRefused([] { PhaseTransform<float>(32, 0); }, "32", "0");
    expectRefused([] { PhaseTransform<float>(0, 4); }, "0", "4");
    expectRefused([] { PhaseTransform<float>(65536, 32768); }, "65536", "32768");
}

}  // namespace
}  // namespace bandvox

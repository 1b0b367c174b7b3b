#include "spectral/row_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using Complex = std::complex<float>;

std::complex<double> directSum(const std::vector<float>& row, int k) {
    std::complex<double> sum = 0;
    const auto samples = static_cast<double>(row.size());
    for (std::size_t j = 0; j < row.size(); ++j) {
        sum +=
            std::polar<double>(1.0, -2 * std::numbers::pi * k * static_cast<double>(j) / samples) *
            static_cast<double>(row[j]);
    }
    return sum;
}

// Rows with no step, few, as many as are summed one by one, and more.
TEST(RowTransform, EqualsTheDirectSum) {
    std::mt19937 random(3);
    std::vector<Complex> scratch;
    for (const auto& [samples, frequencies] : {std::pair(96, 24), {74, 74}, {512, 64}}) {
        const RowTransform transform(samples, frequencies);
        for (const int steps : {0, 1, 2, 11, 12, 13, 60}) {
            std::vector<float> rows[2];
            for (std::vector<float>& row : rows) {
                row.assign(samples, 0.25F);
                for (int s = 0; s < steps; ++s) {
                    const auto at = static_cast<std::ptrdiff_t>(random() % samples);
                    for (auto value = row.begin() + at; value != row.end(); ++value) {
                        *value = 1 - *value;
                    }
                }
            }
            const int count = frequencies / 2 + 1;
            std::vector<Complex> spectra[] = {std::vector<Complex>(count),
                                              std::vector<Complex>(count)};
            const bool isOne = transform.pair(rows[0].data(), rows[1].data(), spectra[0].data(),
                                              spectra[1].data(), scratch);
            EXPECT_TRUE(isOne || steps > 0);
            EXPECT_TRUE(!isOne || rows[0] == rows[1]);
            for (int r = 0; r < 2; ++r) {
                for (int k = 0; k < count; ++k) {
                    const std::complex<double> truth =
                        directSum(rows[r], signedFrequency(k, frequencies));
                    EXPECT_NEAR(std::abs(std::complex<double>(spectra[r][k]) - truth), 0,
                                2e-6 * samples)
                        << samples << " samples, " << steps << " steps, frequency " << k;
                }
            }
        }
    }
}

TEST(RowTransform, ConstantRowHasOnlyItsMean) {
    const RowTransform transform(64, 16);
    std::vector<Complex> spectrum(9, Complex(7));
    transform.constant(0.5F, spectrum.data());
    EXPECT_EQ(spectrum[0], Complex(32));
    for (std::size_t k = 1; k < spectrum.size(); ++k) EXPECT_EQ(spectrum[k], Complex(0));
}

TEST(RowTransform, TwoConstantRowsAreOneValueOnlyIfTheirsIs) {
    const RowTransform transform(64, 16);
    const std::vector<float> zero(64, 0.0F);
    const std::vector<float> one(64, 1.0F);
    std::vector<Complex> a(9), b(9), scratch;
    EXPECT_TRUE(transform.pair(one.data(), one.data(), a.data(), b.data(), scratch));
    EXPECT_FALSE(transform.pair(zero.data(), one.data(), a.data(), b.data(), scratch));
}

}  // namespace
}  // namespace bandvox

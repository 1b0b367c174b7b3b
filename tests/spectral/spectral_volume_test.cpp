#include "allocation_meter.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>
#include <bandvox/spectral/field_to_spectrum.h>
#include <bandvox/spectral/spectrum_to_screen.h>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

const SpectralDomain kDomain{Vec3d(-1.3, -1.2, -1.4), 2.7};

// Something smooth that is no solid and has no symmetry, and is not 0 at its box's border.
class Waves final : public FieldSource {
  public:
    std::string name() const override { return "waves"; }
    openvdb::BBoxd bounds() const override { return {Vec3d(-9), Vec3d(9)}; }
    static float at(const Vec3d& p) {
        return static_cast<float>(std::sin(5 * p.x() + 2) * std::cos(3 * p.y()) + 0.3 * p.z() +
                                  p.x() * p.y());
    }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = at(start + double(i) * step);
    }
};

// F(l, m, n) of R³ samples, filtered, by its definition.
std::complex<double> directCoefficient(const FieldSource& source, const SpectrumOptions& options,
                                       int l, int m, int n) {
    const int samples = options.samples;
    const double step = options.domain->side / samples;
    std::complex<double> sum = 0;
    for (int x = 0; x < samples; ++x) {
        for (int y = 0; y < samples; ++y) {
            std::vector<float> row(samples);
            source.sampleRow(options.domain->origin + step * Vec3d(x, y, 0), Vec3d(0, 0, step),
                             row);
            for (int z = 0; z < samples; ++z) {
                const int turns = (l * x + m * y + n * z) % samples;
                sum += double(row[z]) * std::polar(1.0, -2 * std::numbers::pi * turns / samples);
            }
        }
    }
    const double k = std::sqrt(double(l * l + m * m + n * n)) / options.resolution;
    return sum * std::pow(double(options.resolution) / samples, 3) * options.filter(k);
}

template <typename Real>
class SpectralVolumes : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SpectralVolumes, Precisions);

TYPED_TEST(SpectralVolumes, FrequenciesEqualTheDirectSum) {
    const Waves waves;
    const double rounding = std::is_same_v<TypeParam, float> ? 1e-6 : 1e-13;
    for (const auto& [n, samples] : {std::pair(4, 4), std::pair(6, 18), std::pair(8, 32)}) {
        const SpectrumOptions options{n, samples, {4, 0.3}, kDomain};
        const auto volume = fieldToSpectrum<TypeParam>(waves, options);
        std::mt19937 random(3);
        std::uniform_int_distribution<int> any(-n / 2 + 1, n / 2 - 1);
        for (int i = 0; i < 40; ++i) {
            const int l = any(random), m = any(random), k = any(random);
            const auto truth = directCoefficient(waves, options, l, m, k);
            const std::complex<double> found(volume.coefficient(l, m, k));
            EXPECT_LE(std::abs(found - truth), rounding * n * n * n)
                << "N " << n << ", R " << samples << ", " << l << " " << m << " " << k;
        }
        EXPECT_EQ(volume.coefficient(-n / 2, 0, 0), std::complex<TypeParam>(0));
        EXPECT_EQ(volume.coefficient(0, -n / 2, 1), std::complex<TypeParam>(0));
        EXPECT_EQ(volume.coefficient(1, 0, -n / 2), std::complex<TypeParam>(0));
    }
}

TYPED_TEST(SpectralVolumes, LatticeEqualsTheDirectSum) {
    const auto source = makeShapeField("shape:hyperboloid");
    const int n = 12;
    const auto volume = fieldToSpectrum<TypeParam>(*source, {n, 48, {2, 0.16}, kDomain});
    const std::vector<TypeParam> lattice = volume.lattice();
    const double rounding = std::is_same_v<TypeParam, float> ? 2e-6 : 1e-13;
    for (const auto& [x, y, z] : {std::tuple(0, 0, 0), std::tuple(6, 5, 7), std::tuple(11, 1, 4)}) {
        EXPECT_NEAR(lattice[(x * n + y) * n + z], volume.directValue(Vec3d(x, y, z)), rounding);
    }
    // The mean is the solid's share of the domain, as far as R³ samples know it.
    double sum = 0;
    for (const TypeParam value : lattice) sum += value;
    EXPECT_NEAR(sum, volume.coefficient(0, 0, 0).real(), 1e-4);
}

TEST(SpectralVolumeTest, GradientIsTheDerivativeOfTheValue) {
    const auto source = makeShapeField("shape:torus");
    const auto volume = fieldToSpectrum<double>(*source, {10, 40, {2, 0.16}, kDomain});
    const Vec3d at(3.3, 6.1, 4.7);
    const Vec3d gradient = volume.directGradient(at);
    const double h = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d step(0.0);
        step[axis] = h;
        const double difference = (volume.directValue(at + step) - volume.directValue(at - step));
        EXPECT_NEAR(gradient[axis], difference / (2 * h), 1e-6);
    }
}

// Algorithm I's working memory, R + RN for each thread and RN² for all, as complex numbers, of
// which rows of N/2 + 1 (padded) stand for N.
TEST(SpectralVolumeTest, WorkingMemoryIsThePapers) {
    const auto source = makeShapeField("shape:sphere");
    for (const auto& [n, samples] : {std::pair(16, 256), std::pair(32, 128)}) {
        const double half = BasicSpectralVolume<float>(n, samples, {}, {}).rowStride();
        const AllocationMeter meter;
        const SpectralVolume volume = fieldToSpectrum(*source, {n, samples, {}, kDomain});
        const double result = volume.size() * sizeof(std::complex<float>);
        const double bytes = meter.peak() - result;
        const double r = samples;
        const double forAll = r * n * half;
        const double forThread = 4 * r + r * half + n * half;
        const double numbers = forAll + threadCount() * forThread;
        EXPECT_LE(bytes, 1.02 * numbers * sizeof(std::complex<float>) + 65536);
        EXPECT_GE(bytes, forAll * sizeof(std::complex<float>));
    }
}

TEST(SpectralVolumeTest, MultiplicationsAreAtMostThePapers) {
    const auto source = makeShapeField("shape:sphere");
    const int n = 16, r = 64;
    OperationCount count;
    fieldToSpectrum(*source, {n, r, {}, SpectralDomain()}, silentProgress(), &count);
    const double reduce = r * (1 + std::log2(n));  // T_N
    EXPECT_LE(count.multiplications, (double(r) * r + double(r) * n + double(n) * n) * reduce);
    EXPECT_GE(count.multiplications, 0.2 * double(r) * r * reduce);
}

TEST(SpectralVolumeTest, ThreadsChangeNothing) {
    const auto source = makeShapeField("shape:tree");
    const SpectrumOptions options{20, 100, {4, 0.25}, kDomain};
    std::vector<SpectralVolume> volumes;
    std::vector<Screen> screens;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        volumes.push_back(fieldToSpectrum(*source, options));
        screens.push_back(spectrumToScreen(volumes.back(), {3, 0.4}));
    }
    for (int l = 0; l < 20; ++l) {
        for (int m = 0; m < 20; ++m) {
            for (int k = 0; k <= 10; ++k) {
                ASSERT_EQ(volumes[0].row(l, m)[k], volumes[1].row(l, m)[k]);
            }
        }
    }
    EXPECT_EQ(screens[0].depth, screens[1].depth);
    EXPECT_EQ(screens[0].normal, screens[1].normal);
}

// 1 everywhere, of which no more is seen than its box.
class EndlessField final : public FieldSource {
  public:
    std::string name() const override { return "endless"; }
    openvdb::BBoxd bounds() const override { return {Vec3d(-0.49), Vec3d(0.49)}; }
    void sampleRow(const Vec3d&, const Vec3d&, std::span<float> values) const override {
        std::fill(values.begin(), values.end(), 1.0F);
    }
};

// 31 of 64 samples lie in the box along each axis; 63 of 128.
TEST(SpectralVolumeTest, AFieldEndsWithItsBox) {
    for (const int samples : {64, 128}) {
        const int inside = samples / 2 - 1;
        const SpectralVolume volume =
            fieldToSpectrum(EndlessField(), {16, samples, {2, 0.16}, SpectralDomain{Vec3d(-1), 2}});
        EXPECT_NEAR(volume.coefficient(0, 0, 0).real() * std::pow(samples / 16.0, 3),
                    std::pow(inside, 3), 0.01);
    }
}

template <typename Make>
void expectRefused(const Make& make, const std::vector<std::string>& values) {
    try {
        make();
        FAIL() << values.front() << " was taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        for (const std::string& value : values) {
            EXPECT_NE(std::string(error.what()).find(value), std::string::npos) << error.what();
        }
    }
}

TEST(SpectralVolumeTest, WrongSizesAreRefusedWithTheirValues) {
    const auto source = makeShapeField("shape:sphere");
    const auto make = [&](int n, int r) {
        return [&source, n, r] { fieldToSpectrum(*source, {n, r, {}, {}}); };
    };
    expectRefused(make(64, 32), {"64", "32"});
    expectRefused(make(48, 100), {"48", "100"});
    expectRefused(make(15, 60), {"15"});
    expectRefused(make(0, 64), {"0"});
    expectRefused(make(-8, 64), {"-8"});
    expectRefused(make(8, 0), {"8", "0"});
    expectRefused(make(8192, 8192), {"8192"});
    expectRefused(
        [&] {
            fieldToSpectrum(*source, {8, 16, {}, SpectralDomain{Vec3d(0), 0}});
        },
        {"0"});
    for (const double far : {double(NAN), HUGE_VAL, -HUGE_VAL, 1e300}) {
        const auto makeFar = [&] {
            fieldToSpectrum(*source, {8, 16, {}, SpectralDomain{Vec3d(0, far, 0), 2}});
        };
        expectRefused(makeFar, {std::isnan(far) ? "nan" : std::isinf(far) ? "inf" : "1e+300", "2"});
    }
    const SpectralVolume volume = fieldToSpectrum(*source, {8, 16, {}, {}});
    expectRefused([&] { spectrumToScreen(volume, {0}); }, {"8", "0"});
    expectRefused([&] { spectrumToScreen(volume, {1 << 20}); }, {"8", std::to_string(1 << 20)});
    expectRefused([&] { spectrumToScreen(volume, {4, NAN}); }, {"nan"});
    // 4096 numbers along each side of which 2^20 are sampled: more than any machine has.
    try {
        fieldToSpectrum(*source, {4096, 1 << 20, {}, {}});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Memory);
    }
}

}  // namespace
}  // namespace bandvox

#include "allocation_meter.h"

#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>
#include <bandvox/spectral/field_to_spectrum.h>
#include <bandvox/spectral/spectrum_to_screen.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

const SpectralDomain kDomain{Vec3d(-1.5, -1.5, -1.5), 3};

// The M³ densities by the full zero-padded transform, one axis after the other, by its definition.
class PaddedTransform {
  public:
    PaddedTransform(const PreciseSpectralVolume& volume, int magnification)
        : mN(volume.resolution()), mM(mN * magnification), mValues(transform(volume, Vec3d(0))) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d along(0.0);
            along[axis] = 1;
            mGradient[axis] = transform(volume, along);
        }
    }

    double maximum() const { return *std::max_element(mValues.begin(), mValues.end()); }
    double value(int x, int y, int z) const { return mValues[index(x, y, z)]; }
    Vec3d gradient(int x, int y, int z) const {
        const std::size_t i = index(x, y, z);
        return Vec3d(mGradient[0][i], mGradient[1][i], mGradient[2][i]);
    }

  private:
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(x) * mM + y) * mM + z;
    }

    // Frequencies times 2πi/N of the axis `along`, or as they are.
    std::vector<double> transform(const PreciseSpectralVolume& volume, const Vec3d& along) const {
        using Complex = std::complex<double>;
        std::vector<Complex> data;
        const auto k = [this](int i) { return i - mN / 2; };
        for (int l = 0; l < mN; ++l) {
            for (int m = 0; m < mN; ++m) {
                for (int n = 0; n < mN; ++n) {
                    Complex value = volume.coefficient(k(l), k(m), k(n));
                    if (along != Vec3d(0.0)) {
                        value *= Complex(
                            0, 2 * std::numbers::pi / mN * along.dot(Vec3d(k(l), k(m), k(n))));
                    }
                    data.push_back(value);
                }
            }
        }
        // Each pass transforms the last axis and makes it the first.
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t rows = data.size() / mN;
            std::vector<Complex> next(rows * mM);
            for (int x = 0; x < mM; ++x) {
                for (std::size_t row = 0; row < rows; ++row) {
                    Complex sum = 0;
                    for (int i = 0; i < mN; ++i) {
                        sum += data[row * mN + i] *
                               std::polar(1.0, 2 * std::numbers::pi * (k(i) * x % mM) / mM);
                    }
                    next[x * rows + row] = sum / double(mN);
                }
            }
            data = std::move(next);
        }
        std::vector<double> real;
        for (const Complex& value : data) real.push_back(value.real());
        return real;
    }

    int mN, mM;
    std::vector<double> mValues;
    std::vector<double> mGradient[3];
};

class ScreenOfShape : public testing::TestWithParam<const char*> {};

TEST_P(ScreenOfShape, EqualsThePaddedTransform) {
    const auto source = makeShapeField(GetParam());
    const int n = 10, magnification = 3, m = n * magnification;
    const auto volume = fieldToSpectrum<double>(*source, {n, 40, {2, 0.16}, kDomain});
    const PaddedTransform truth(volume, magnification);
    const double iso = 0.5 * truth.maximum();
    for (const bool onlySeen : {false, true}) {
        const Screen screen = spectrumToScreen(
            volume, {.magnification = magnification, .iso = iso, .onlySeen = onlySeen});
        ASSERT_EQ(screen.size, m);
        int seen = 0;
        for (int y = 0; y < m; ++y) {
            for (int x = 0; x < m; ++x) {
                // Figure 7: the first place above iso, or the one before if it is nearer.
                int z = 0;
                while (z < m && truth.value(x, y, z) <= iso) ++z;
                const float depth = screen.depth[y * m + x];
                if (z == m) {
                    EXPECT_TRUE(std::isinf(depth)) << x << " " << y;
                    EXPECT_EQ(screen.normal[y * m + x], openvdb::Vec3f(0.0F));
                    continue;
                }
                if (z > 0 && iso - truth.value(x, y, z - 1) < truth.value(x, y, z) - iso) --z;
                EXPECT_FLOAT_EQ(depth, static_cast<float>(z) / magnification) << x << " " << y;
                const Vec3d normal(screen.normal[y * m + x]);
                EXPECT_LE((normal + truth.gradient(x, y, z)).length(), 1e-6) << x << " " << y;
                ++seen;
            }
        }
        EXPECT_GT(seen, m);
        EXPECT_LT(seen, m * m);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ScreenOfShape,
                         testing::Values("shape:hyperboloid", "shape:cube", "shape:two-balls",
                                         "shape:tree"));

// A density of random waves, which all have their counterparts; `flat`: constant along z.
PreciseSpectralVolume randomVolume(int n, bool flat, unsigned seed) {
    PreciseSpectralVolume volume(n, n, {2, 0.16}, kDomain);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto mirror = [n](int i) { return (n - i) % n; };
    for (int l = 0; l < n; ++l) {
        for (int m = 0; m < n; ++m) {
            if (2 * l == n || 2 * m == n) continue;
            for (int k = 1; 2 * k < n && !flat; ++k) {
                volume.row(l, m)[k] = {normal(random), normal(random)};
            }
            const std::complex<double> value(normal(random), normal(random));
            volume.row(l, m)[0] += value;
            volume.row(mirror(l), mirror(m))[0] += std::conj(value);
        }
    }
    return volume;
}

// Section 5.3 leaves out what cannot be seen, and nothing else.
TEST(SpectrumToScreen, NothingThatIsSeenIsLeftOut) {
    int seen = 0;
    const auto expectSame = [&](const PreciseSpectralVolume& volume, double iso) {
        const Screen all =
            spectrumToScreen(volume, {.magnification = 2, .iso = iso, .onlySeen = false});
        const Screen some =
            spectrumToScreen(volume, {.magnification = 2, .iso = iso, .onlySeen = true});
        EXPECT_EQ(all.depth, some.depth) << iso;
        for (std::size_t i = 0; i < all.normal.size(); ++i) {
            EXPECT_LE((all.normal[i] - some.normal[i]).length(), 1e-5F) << i;
            if (!std::isinf(all.depth[i])) ++seen;
        }
    };
    for (unsigned seed = 0; seed < 100; ++seed) {
        const PreciseSpectralVolume volume = randomVolume(4 + 2 * (seed % 4), seed % 2 == 1, seed);
        const std::vector<double> values = volume.lattice();
        const double highest = *std::max_element(values.begin(), values.end());
        for (const double part : {0.3, 0.6, 0.9, 1.0}) expectSame(volume, part * highest);
    }
    EXPECT_GT(seen, 1000);

    // Solids anywhere in the domain, and beyond its end.
    for (const char* shape : {"shape:tree", "shape:hyperboloid", "shape:sphere"}) {
        for (const Vec3d origin : {Vec3d(-1.3, -1.2, -1.4), Vec3d(-1.9, -1.05, -1.2), Vec3d(0)}) {
            const auto volume = fieldToSpectrum<double>(
                *makeShapeField(shape), {16, 64, {2, 0.16}, SpectralDomain{origin, 3}});
            const std::vector<double> values = volume.lattice();
            const double highest = *std::max_element(values.begin(), values.end());
            for (const double part : {0.5, 0.8, 0.95}) expectSame(volume, part * highest);
        }
    }
}

TEST(SpectrumToScreen, SingleAndDoublePrecisionSeeTheSame) {
    const auto source = makeShapeField("shape:torus");
    const SpectrumOptions options{16, 128, {2, 0.16}, kDomain};
    const ScreenOptions look{.magnification = 4, .iso = 0.25, .refine = true};
    const Screen single = spectrumToScreen(fieldToSpectrum<float>(*source, options), look);
    const Screen precise = spectrumToScreen(fieldToSpectrum<double>(*source, options), look);
    int seen = 0;
    for (std::size_t i = 0; i < single.depth.size(); ++i) {
        if (std::isinf(single.depth[i]) || std::isinf(precise.depth[i])) continue;
        // At the rim, where lines of sight graze the surface, depth is ill-conditioned.
        if (std::abs(precise.normal[i].z()) < 0.2F * precise.normal[i].length()) continue;
        EXPECT_NEAR(single.depth[i], precise.depth[i], 1e-4);
        EXPECT_LE((single.normal[i] - precise.normal[i]).length(), 1e-4F);
        ++seen;
    }
    EXPECT_GT(seen, 500);
}

TEST(SpectrumToScreen, RefinedCrossingsLieOnTheSurface) {
    const auto source = makeShapeField("shape:two-balls");
    const auto volume = fieldToSpectrum<double>(*source, {8, 64, {2, 0.16}, kDomain});
    const int magnification = 4, m = 8 * magnification;
    const double iso = 0.15;  // the balls are small: the density does not rise to 0.5
    ScreenOptions options{.magnification = magnification, .iso = iso};
    const Screen coarse = spectrumToScreen(volume, options);
    options.refine = true;
    const Screen fine = spectrumToScreen(volume, options);
    int seen = 0;
    for (int y = 0; y < m; ++y) {
        for (int x = 0; x < m; ++x) {
            const float z = fine.depth[y * m + x];
            ASSERT_EQ(std::isinf(z), std::isinf(coarse.depth[y * m + x]));
            if (std::isinf(z)) continue;
            EXPECT_LE(std::abs(z - coarse.depth[y * m + x]), 1.0F / magnification);
            const Vec3d at(double(x) / magnification, double(y) / magnification, z);
            EXPECT_NEAR(volume.directValue(at), iso, 1e-5);
            EXPECT_LE((Vec3d(fine.normal[y * m + x]) + volume.directGradient(at)).length(), 1e-5);
            ++seen;
        }
    }
    EXPECT_GT(seen, 100);
}

// N³ + N² + LN numbers, N² + LN of them in each thread; N/2 + 1 (padded) stand for N.
TEST(SpectrumToScreen, WorkingMemoryIsThePapers) {
    const auto source = makeShapeField("shape:sphere");
    const int n = 24, magnification = 6;
    const SpectralVolume volume = fieldToSpectrum(*source, {n, 96, {}, kDomain});
    for (const bool onlySeen : {false, true}) {
        const AllocationMeter meter;
        const Screen screen =
            spectrumToScreen(volume, {.magnification = magnification, .onlySeen = onlySeen});
        const double result = screen.depth.size() * 4.0 * sizeof(float);
        const double half = volume.rowStride();
        const double tables = double(n) * magnification + n;
        // A transform's input is a copy of what it was turned from: N² more, or twice that.
        const double perThread = (onlySeen ? 3 : 2) * n * half + magnification * (half + n);
        const double numbers = n * n * half + threadCount() * perThread + tables;
        EXPECT_LE(meter.peak() - result, 1.05 * numbers * sizeof(std::complex<float>) + 32768);
    }
}

TEST(SpectrumToScreen, MultiplicationsAreAtMostThePapers) {
    const auto source = makeShapeField("shape:sphere");
    const int n = 16, l = 8;
    const SpectralVolume volume =
        fieldToSpectrum(*source, {n, 64, {}, SpectralDomain{Vec3d(-2), 4}});
    OperationCount all, seen;
    spectrumToScreen(volume, {.magnification = l, .onlySeen = false}, silentProgress(), &all);
    spectrumToScreen(volume, {.magnification = l, .onlySeen = true}, silentProgress(), &seen);
    const double magnify = l * n * (1 + std::log2(n));  // T_A
    const double n2 = double(n) * n, l2 = double(l) * l, n3 = n2 * n;
    const double paper = (1 + l + l2) * n2 * magnify + l2 * n3 +  // densities, z
                         l * n2 * magnify + l2 * n3 +             // x
                         (l + 1) * n2 * magnify + l2 * n3;        // y
    EXPECT_LE(all.multiplications, paper);
    EXPECT_GE(all.multiplications, 0.3 * paper);
    EXPECT_LE(seen.multiplications, 0.6 * all.multiplications);
}

}  // namespace
}  // namespace bandvox

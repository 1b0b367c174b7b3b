#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/spectral/exponential_filter.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace {

using bandvox::BrickReconstructionOptions;
using bandvox::DensityAt;
using bandvox::Error;
using bandvox::ErrorKind;
using bandvox::ExponentialFilter;
using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-4;
constexpr double kDegree = kPi / 180;

const ExponentialFilter kFilters[] = {{2, 0.16}, {4, 0.2}, {4, 0.28}, {8, 0.35}};

// A density with a closed form, and the lattice of its samples.
class Truth {
  public:
    virtual ~Truth() = default;
    virtual DensityAt operator()(const Vec3d& x) const = 0;

    openvdb::FloatGrid::Ptr sample(const openvdb::CoordBBox& box) const {
        auto grid = openvdb::FloatGrid::create(0);
        auto accessor = grid->getAccessor();
        for (auto it = box.begin(); it; ++it) {
            accessor.setValue(*it, static_cast<float>((*this)((*it).asVec3d()).value));
        }
        return grid;
    }
};

// The filtered density across a flat face and its slope, in a table fine enough for 1e-9.
class FaceProfile {
  public:
    explicit FaceProfile(const ExponentialFilter& filter) {
        for (int i = -kReach * kPerVoxel; i <= kReach * kPerVoxel; ++i) {
            const double r = double(i) / kPerVoxel;
            mNodes.push_back({bandvox::halfSpaceDensity(filter, r), slopeBySimpson(filter, r)});
        }
    }

    // {s(r), s'(r)} by Hermite's cubic.
    std::pair<double, double> operator()(double r) const {
        if (r <= -kReach) return {1, 0};
        if (r >= kReach) return {0, 0};
        const double place = (r + kReach) * kPerVoxel;
        const auto i = std::min(static_cast<std::size_t>(place), mNodes.size() - 2);
        const double t = place - double(i);
        const auto [s0, d0] = mNodes[i];
        const auto [s1, d1] = mNodes[i + 1];
        const double a = d0 / kPerVoxel, b = 3 * (s1 - s0) - (2 * d0 + d1) / kPerVoxel;
        const double c = (d0 + d1) / kPerVoxel - 2 * (s1 - s0);
        return {s0 + t * (a + t * (b + t * c)), (a + t * (2 * b + t * 3 * c)) * kPerVoxel};
    }

  private:
    static constexpr int kReach = 40;
    static constexpr int kPerVoxel = 50;

    // -2 ∫_0^1 H(k) cos(2πkr) dk; beyond 1 cycle per voxel, H is nothing.
    static double slopeBySimpson(const ExponentialFilter& filter, double r) {
        constexpr int kSteps = 600;
        double sum = 0;
        for (int i = 0; i <= kSteps; ++i) {
            const double k = double(i) / kSteps;
            const double weight = i == 0 || i == kSteps ? 1 : (i % 2 ? 4 : 2);
            sum += weight * filter(k) * std::cos(2 * kPi * k * r);
        }
        return -2 * sum / (3 * kSteps);
    }

    std::vector<std::pair<double, double>> mNodes;
};

// A half-space {x·n < offset}.
class HalfSpace final : public Truth {
  public:
    HalfSpace(const FaceProfile& profile, const Vec3d& direction, double offset)
        : mProfile(profile), mNormal(direction.unit()), mOffset(offset) {}

    DensityAt operator()(const Vec3d& x) const override {
        const auto [value, slope] = mProfile(x.dot(mNormal) - mOffset);
        return {value, slope * mNormal};
    }

  private:
    const FaceProfile& mProfile;
    Vec3d mNormal;
    double mOffset;
};

// A ball filtered with exp(-(|k|/k_c)²).
class GaussianBall final : public Truth {
  public:
    GaussianBall(double cutoff, const Vec3d& center, double radius)
        : mSigma(1 / (std::numbers::sqrt2 * kPi * cutoff)), mCenter(center), mRadius(radius) {}

    DensityAt operator()(const Vec3d& x) const override {
        const double r = (x - mCenter).length();
        const double s = std::numbers::sqrt2 * mSigma;
        const double a = (mRadius - r) / s, b = (mRadius + r) / s;
        const double tail = s / (2 * r * std::sqrt(kPi));
        const double value =
            0.5 * (std::erf(a) + std::erf(b)) - tail * (std::exp(-a * a) - std::exp(-b * b));
        const double slope = tail * ((std::exp(-a * a) - std::exp(-b * b)) / r -
                                     2 * mRadius / (s * s) * (std::exp(-a * a) + std::exp(-b * b)));
        return {value, slope * (x - mCenter) / r};
    }

  private:
    double mSigma;
    Vec3d mCenter;
    double mRadius;
};

std::unique_ptr<bandvox::Reconstruction> reconstruct(openvdb::FloatGrid::ConstPtr grid,
                                                     const ExponentialFilter& filter,
                                                     double tolerance = kTolerance) {
    BrickReconstructionOptions options;
    options.filter = filter;
    options.tolerance = tolerance;
    return bandvox::makeBrickReconstruction(std::move(grid), options);
}

struct Errors {
    double value = 0;
    double gradient = 0;  // relative to the steepest
    double angle = 0;     // radians, where the gradient is above 5 % of the steepest
};

// Compares at scattered places within `half` of `center`.
Errors compare(const Truth& truth, const bandvox::Reconstruction& reconstruction,
               const Vec3d& center, double half, int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(-half, half);
    std::vector<DensityAt> expected(count), found(count);
    double steepest = 0;
    const auto probe = reconstruction.probe();
    for (int i = 0; i < count; ++i) {
        const Vec3d x = center + Vec3d(offset(random), offset(random), offset(random));
        expected[i] = truth(x);
        found[i] = probe->evaluate(x);
        EXPECT_NEAR(probe->value(x), found[i].value, 1e-6);
        steepest = std::max(steepest, expected[i].gradient.length());
    }
    Errors errors;
    for (int i = 0; i < count; ++i) {
        const Vec3d &e = expected[i].gradient, &f = found[i].gradient;
        errors.value = std::max(errors.value, std::abs(expected[i].value - found[i].value));
        errors.gradient = std::max(errors.gradient, (e - f).length() / steepest);
        if (e.length() > 0.05 * steepest) {
            errors.angle = std::max(errors.angle, std::atan2(e.cross(f).length(), e.dot(f)));
        }
    }
    return errors;
}

class EachFilter : public testing::TestWithParam<ExponentialFilter> {};

TEST_P(EachFilter, ReadsPlanesOfAnyOrientation) {
    // The cube straddles brick borders at 0 and 32.
    const openvdb::CoordBBox box(Coord(-28), Coord(64));
    const Vec3d center(16.3, 15.8, 16.1);
    const FaceProfile profile(GetParam());
    for (const Vec3d& direction : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, -1), Vec3d(1, 1, 0),
                                   Vec3d(0.3, -0.5, 0.81)}) {
        const HalfSpace truth(profile, direction, direction.unit().dot(center) + 0.37);
        const auto reconstruction = reconstruct(truth.sample(box), GetParam());
        const Errors errors = compare(truth, *reconstruction, center, 18, 1500);
        EXPECT_LE(errors.value, kTolerance) << direction;
        EXPECT_LE(errors.gradient, kTolerance) << direction;
        EXPECT_LE(errors.angle, 0.05 * kDegree) << direction;
    }
}

// The direct Fourier sum of a random lattice of period P whose spectrum is that of a filtered
// solid: a few waves of each frequency, of size H(k)/k.
class RandomWaves final : public Truth {
  public:
    RandomWaves(const ExponentialFilter& filter, int period) {
        std::mt19937 random(11);
        std::uniform_int_distribution<int> wave(-period / 2 + 1, period / 2 - 1);
        std::uniform_real_distribution<double> phase(0, 2 * kPi);
        double sum = 0;
        while (mWaves.size() < 60) {
            const Vec3d k = Vec3d(wave(random), wave(random), wave(random)) / period;
            if (k.length() == 0 || k.length() > 0.5) continue;
            const double size = filter(k.length()) / k.length();
            mWaves.push_back({k, size, phase(random)});
            sum += size;
        }
        for (Wave& w : mWaves) w.size /= sum;
    }

    DensityAt operator()(const Vec3d& x) const override {
        DensityAt at;
        for (const Wave& w : mWaves) {
            const double angle = 2 * kPi * w.k.dot(x) + w.phase;
            at.value += w.size * std::cos(angle);
            at.gradient -= 2 * kPi * w.size * std::sin(angle) * w.k;
        }
        return at;
    }

  private:
    struct Wave {
        Vec3d k;
        double size, phase;
    };
    std::vector<Wave> mWaves;
};

TEST_P(EachFilter, AgreesWithTheDirectFourierSum) {
    const RandomWaves truth(GetParam(), 24);
    const auto grid = truth.sample(openvdb::CoordBBox(Coord(-30), Coord(61)));
    const auto reconstruction = reconstruct(grid, GetParam());
    const Errors errors = compare(truth, *reconstruction, Vec3d(15.5), 19, 4000);
    EXPECT_LE(errors.value, kTolerance);
    EXPECT_LE(errors.gradient, 2 * kTolerance);
    EXPECT_LE(errors.angle, 0.1 * kDegree);
}

TEST_P(EachFilter, FollowsTheToleranceAskedFor) {
    const openvdb::CoordBBox box(Coord(-28, -28, -28), Coord(40, 40, 40));
    const Vec3d center(6, 5.5, 6.4), direction(0.2, 0.9, 0.4);
    const FaceProfile profile(GetParam());
    const HalfSpace truth(profile, direction, direction.unit().dot(center));
    const auto grid = truth.sample(box);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const auto reconstruction = reconstruct(grid, GetParam(), tolerance);
        const Errors errors = compare(truth, *reconstruction, center, 6, 600);
        EXPECT_LE(errors.value, tolerance);
        EXPECT_LE(errors.gradient, tolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(Filters, EachFilter, testing::ValuesIn(kFilters));

TEST(BrickReconstruction, ReadsAFilteredBall) {
    const GaussianBall truth(0.16, Vec3d(31.7, 32.2, 30.9), 14.6);
    const auto grid = truth.sample(openvdb::CoordBBox(Coord(2), Coord(62)));
    const auto reconstruction = reconstruct(grid, {2, 0.16});
    const Errors errors = compare(truth, *reconstruction, Vec3d(32), 17, 20000);
    EXPECT_LE(errors.value, kTolerance);
    EXPECT_LE(errors.gradient, kTolerance);
    EXPECT_LE(errors.angle, 0.05 * kDegree);
}

TEST(BrickReconstruction, IsSmoothAcrossBrickBorders) {
    const FaceProfile profile({4, 0.28});
    const HalfSpace truth(profile, Vec3d(0.5, 0.6, 0.7), 0.2);
    const auto grid = truth.sample(openvdb::CoordBBox(Coord(-26), Coord(26)));
    const auto reconstruction = reconstruct(grid, {4, 0.28});
    for (double y = -2; y < 2; y += 0.31) {
        const DensityAt left = reconstruction->evaluate(Vec3d(-1e-12, y, 0.4));
        const DensityAt right = reconstruction->evaluate(Vec3d(1e-12, y, 0.4));
        EXPECT_NEAR(left.value, right.value, 1e-6);
        EXPECT_LE((left.gradient - right.gradient).length(), 2e-6);
    }
}

TEST(BrickReconstruction, ReadsTilesAndBackground) {
    auto grid = openvdb::FloatGrid::create(0.25F);
    grid->tree().addTile(2, Coord(0), 1.0F, true);  // 128³ voxels
    const auto reconstruction = reconstruct(grid, {2, 0.16});
    EXPECT_NEAR(reconstruction->value(Vec3d(64.2, 70.1, 63.9)), 1, 1e-6);
    EXPECT_NEAR(reconstruction->value(Vec3d(-64.2, 70.1, 63.9)), 0.25, 1e-6);
    EXPECT_NEAR(reconstruction->value(Vec3d(-0.5, 70.1, 63.9)), 0.625, 1e-3);
    EXPECT_EQ(reconstruction->evaluate(Vec3d(64.2, 70.1, 63.9)).gradient, Vec3d(0.0));
}

TEST(BrickReconstruction, ReadsAnEmptyGridAndPlacesOutOfTheWorld) {
    const auto reconstruction = reconstruct(openvdb::FloatGrid::create(0.5F), {2, 0.16});
    for (const double x : {0.0, -1e7, 1e12, -1e300, std::nan(""), HUGE_VAL}) {
        const DensityAt at = reconstruction->evaluate(Vec3d(0.3, x, 2));
        EXPECT_EQ(at.value, 0.5) << x;
        EXPECT_EQ(at.gradient, Vec3d(0.0)) << x;
    }
}

TEST(BrickReconstruction, DoesNotDependOnThreadsOrOnTheCache) {
    const GaussianBall truth(0.16, Vec3d(3.7, 1.2, -2.9), 20.6);
    const auto grid = truth.sample(openvdb::CoordBBox(Coord(-30), Coord(30)));
    constexpr int kTasks = 16, kPlaces = 60;
    const auto readAll = [&](int threads, std::size_t cacheBytes) {
        const bandvox::ThreadLimit limit(threads);
        BrickReconstructionOptions options;
        options.cacheBytes = cacheBytes;
        const auto reconstruction = bandvox::makeBrickReconstruction(grid, options);
        std::vector<double> values(kTasks * kPlaces);
        bandvox::parallelFor(kTasks, [&](std::int64_t task) {
            std::mt19937 random(static_cast<unsigned>(task));
            std::uniform_real_distribution<double> place(-60, 60);
            const auto probe = reconstruction->probe();
            for (int i = 0; i < kPlaces; ++i) {
                const Vec3d x(place(random), place(random), place(random));
                const DensityAt at = i % 2 ? probe->evaluate(x) : reconstruction->evaluate(x);
                values[task * kPlaces + i] = at.value + at.gradient[task % 3];
            }
        });
        return values;
    };
    const std::vector<double> alone = readAll(1, std::size_t(512) << 20);
    EXPECT_EQ(alone, readAll(4, std::size_t(512) << 20));
    EXPECT_EQ(alone, readAll(4, 0));
}

ErrorKind kindOfRefusal(openvdb::FloatGrid::ConstPtr grid,
                        const BrickReconstructionOptions& options) {
    try {
        bandvox::makeBrickReconstruction(std::move(grid), options);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorKind::Runtime;
}

TEST(BrickReconstruction, RefusesWhatItCannotReach) {
    const auto grid = openvdb::FloatGrid::create(0);
    EXPECT_EQ(kindOfRefusal(nullptr, {}), ErrorKind::Usage);
    BrickReconstructionOptions options;
    for (const double tolerance : {0.0, 1e-7, 0.2, -1.0, std::nan("")}) {
        options.tolerance = tolerance;
        EXPECT_EQ(kindOfRefusal(grid, options), ErrorKind::Usage) << tolerance;
    }
    options.tolerance = 1e-4;
    options.filter = {64, 0.5};  // everything up to Nyquist
    EXPECT_EQ(kindOfRefusal(grid, options), ErrorKind::Usage);
    options.filter = {-1, 0.2};
    EXPECT_EQ(kindOfRefusal(grid, options), ErrorKind::Usage);
}

}  // namespace

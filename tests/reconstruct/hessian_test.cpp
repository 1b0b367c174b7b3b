#include "reconstruct/interpolation_design.h"
#include "reconstruct/random_lattice.h"

#include <bandvox/reconstruct/brick_reconstruction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Mat3d;
using openvdb::Vec3d;
using reconstruct_test::RandomLattice;

constexpr double kPi = std::numbers::pi;

double largest(const Mat3d& m) {
    double most = 0;
    for (int i = 0; i < 9; ++i) most = std::max(most, std::abs(m.asPointer()[i]));
    return most;
}

std::vector<Vec3d> places(int count, double low, double high, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(low, high);
    std::vector<Vec3d> all;
    for (int i = 0; i < count; ++i)
        all.emplace_back(uniform(random), uniform(random), uniform(random));
    return all;
}

struct Case {
    ExponentialFilter filter;
    double tolerance;
    int lanes;  // that the kernel takes
};

class EachKernel : public testing::TestWithParam<Case> {
  protected:
    std::unique_ptr<Reconstruction> reconstruct(const openvdb::FloatGrid::ConstPtr& grid) const {
        BrickReconstructionOptions options;
        options.filter = GetParam().filter;
        options.tolerance = GetParam().tolerance;
        return makeBrickReconstruction(grid, options);
    }
};

TEST_P(EachKernel, IsAsWideAsThisTestMeans) {
    const auto design = designInterpolation(GetParam().filter, GetParam().tolerance);
    EXPECT_EQ(design.kernel.paddedWidth(), GetParam().lanes);
}

TEST_P(EachKernel, ExpandsAsTheDirectSumDoes) {
    const RandomLattice truth(GetParam().filter, 0.5, 3);
    const auto reconstruction = reconstruct(truth.grid(40));
    const auto probe = reconstruction->probe();
    double most = 0, error = 0;
    for (const Vec3d& place : places(80, 0, RandomLattice::kPeriod, 4)) {
        const DensityExpansion expected = truth(place), found = probe->expand(place);
        most = std::max(most, largest(expected.hessian));
        error = std::max(error, largest(found.hessian - expected.hessian));
        EXPECT_TRUE(found.hessian.eq(found.hessian.transpose(), 0.0));
        // The same sums as without second derivatives.
        const DensityAt at = probe->evaluate(place);
        EXPECT_NEAR(found.value, at.value, 1e-6);
        EXPECT_LT((found.gradient - at.gradient).length(), 2e-6);
        EXPECT_NEAR(found.value, probe->value(place), 1e-6);
        const DensityExpansion locked = reconstruction->expand(place);
        EXPECT_EQ(locked.value, found.value);
        EXPECT_EQ(locked.hessian, found.hessian);
    }
    // Second derivatives weigh each frequency's error by k once more than the gradient.
    EXPECT_LT(error, 20 * GetParam().tolerance * most + 2e-6);
    RecordProperty("error", std::to_string(error / most / GetParam().tolerance));
}

TEST_P(EachKernel, ExpandsAsDifferencesOfTheGradientDo) {
    const RandomLattice truth(GetParam().filter, 0, 8);
    const auto reconstruction = reconstruct(truth.grid(40));
    const auto reader = reconstruction->probe();
    constexpr double kStep = 0.02;
    for (const Vec3d& place : places(100, 1, 63, 9)) {
        const Mat3d hessian = reader->expand(place).hessian;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step(0.0);
            step[axis] = kStep;
            const Vec3d difference = (reader->evaluate(place + step).gradient -
                                      reader->evaluate(place - step).gradient) /
                                     (2 * kStep);
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(hessian(axis, i), difference[i], 3e-4);
        }
    }
}

TEST_P(EachKernel, HasNoCurvatureWhereAllIsAlike) {
    auto grid = openvdb::FloatGrid::create(0.25F);
    grid->tree().addTile(2, Coord(0), 0.7F, true);
    const auto reconstruction = reconstruct(grid);
    for (const Vec3d& place : places(50, 40, 88, 2)) {
        const DensityExpansion at = reconstruction->expand(place);
        EXPECT_NEAR(at.value, 0.7, 1e-6);
        EXPECT_LT(at.gradient.length(), 1e-6);
        EXPECT_LT(largest(at.hessian), 1e-6);
    }
    const DensityExpansion far = reconstruction->expand({1e12, 0, std::nan("")});
    EXPECT_EQ(far.value, 0.25);
    EXPECT_EQ(far.hessian, Mat3d::zero());
}

TEST_P(EachKernel, IsSmoothToSecondOrderAcrossBricks) {
    const RandomLattice truth(GetParam().filter, 0, 12);
    const auto reconstruction = reconstruct(truth.grid(40));
    for (Vec3d place : places(40, 2, 62, 13)) {
        place[2] = 32;
        const DensityExpansion before = reconstruction->expand(place - Vec3d(0, 0, 1e-6));
        const DensityExpansion after = reconstruction->expand(place + Vec3d(0, 0, 1e-6));
        EXPECT_LT(largest(before.hessian - after.hessian), 3e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(Kernels, EachKernel,
                         testing::Values(Case{{2, 0.16}, 1e-4, 8}, Case{{4, 0.2}, 1e-4, 8},
                                         Case{{2, 0.12}, 1e-5, 8}, Case{{4, 0.2}, 1e-6, 16},
                                         Case{{8, 0.35}, 1e-5, 16}));

// A Gaussian blob is what a point filtered by a Gaussian is, in closed form.
TEST(Hessian, IsThatOfAGaussianBlob) {
    const double cutoff = 0.16, variance = 1 / (2 * kPi * kPi * cutoff * cutoff);
    const Vec3d middle(30.4, 33.1, 31.7);
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    const openvdb::CoordBBox box(Coord(8), Coord(56));
    for (auto voxel = box.begin(); voxel; ++voxel) {
        const double square = ((*voxel).asVec3d() - middle).lengthSqr();
        accessor.setValue(*voxel, static_cast<float>(std::exp(-0.5 * square / variance)));
    }
    const auto reconstruction = makeBrickReconstruction(grid, {{2, cutoff}, 1e-4});
    for (const Vec3d& place : places(300, 27, 37, 14)) {
        const Vec3d r = (place - middle) / variance;
        const double value = std::exp(-0.5 * (place - middle).lengthSqr() / variance);
        const Mat3d hessian = reconstruction->expand(place).hessian;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                const double expected = value * (r[i] * r[j] - (i == j ? 1 / variance : 0));
                EXPECT_NEAR(hessian(i, j), expected, 1e-3) << place;
            }
        }
    }
}

openvdb::FloatGrid::Ptr sampled(const openvdb::CoordBBox& box,
                                const std::function<double(const Vec3d&)>& f) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    for (auto voxel = box.begin(); voxel; ++voxel) {
        accessor.setValue(*voxel, static_cast<float>(f((*voxel).asVec3d())));
    }
    return grid;
}

TEST(SplineHessian, IsExactForQuadraticPolynomials) {
    std::mt19937 random(15);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int trial = 0; trial < 3; ++trial) {
        Mat3d second;
        for (int i = 0; i < 3; ++i) {
            for (int j = i; j < 3; ++j) second(i, j) = second(j, i) = uniform(random) / 400;
        }
        const Vec3d slope(uniform(random) / 20, uniform(random) / 20, uniform(random) / 20);
        const auto f = [&](const Vec3d& p) { return 0.5 * p.dot(second * p) + slope.dot(p) + 0.4; };
        const auto spline = makeSplineReconstruction(sampled({Coord(-34), Coord(34)}, f));
        for (const Vec3d& place : places(100, -18, 18, 16)) {
            const DensityExpansion at = spline->expand(place);
            EXPECT_NEAR(at.value, f(place), 1e-5);
            EXPECT_LT((at.gradient - (second * place + slope)).length(), 1e-5);
            EXPECT_LT(largest(at.hessian - second), 1e-5);
        }
    }
}

TEST(SplineHessian, IsContinuousOverNodesAndBrickBorders) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto spline = makeSplineReconstruction(
        sampled({Coord(10), Coord(54)}, [&](const Vec3d&) { return uniform(random); }));
    for (Vec3d place : places(100, 20, 44, 18)) {
        place[1] = std::round(place[1]);
        place[0] = 32;
        const Vec3d hair(1e-6, 1e-6, 0);
        const DensityExpansion before = spline->expand(place - hair);
        const DensityExpansion after = spline->expand(place + hair);
        EXPECT_LT(largest(before.hessian - after.hessian), 2e-4);
        EXPECT_GT(largest(after.hessian), 1e-2);
    }
}

}  // namespace
}  // namespace bandvox

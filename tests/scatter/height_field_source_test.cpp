#include "scatter/test_points.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/scatter/fit_surface.h>
#include <bandvox/scatter/height_field_source.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox {
namespace {

using namespace scatter_test;

TEST(HeightFieldSource, IsClosedAndHasItsVolume) {
    const BsplineSurface surface = fitSurface(sampled(franke33(), bump)).sum();
    const auto source = makeHeightFieldSource("bump", surface, -0.2);
    // By samples, whose trapezoid rule converges with the square of their distance.
    constexpr int kSide = 801;
    double volume = 0;
    const auto heights = surface.sample({kSide, kSide});
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const double weight =
                (i % (kSide - 1) == 0 ? 0.5 : 1) * (j % (kSide - 1) == 0 ? 0.5 : 1);
            volume += weight * (heights[static_cast<std::size_t>(i * kSide + j)] + 0.2);
        }
    }
    volume /= (kSide - 1.0) * (kSide - 1.0);
    EXPECT_NEAR(source->volume(), volume, 1e-6);
    EXPECT_NEAR(source->bounds().min()[2], -0.2, 1e-12);
    // The box ends at the surface, and not at its control points.
    const double top = *std::max_element(heights.begin(), heights.end());
    EXPECT_GE(source->bounds().max()[2], top - 1e-9);
    EXPECT_LE(source->bounds().max()[2], top + 5e-6);
    // The exact route measures whether the surface is closed, and the density keeps the volume.
    const DensityResult density = surfaceToDensity(*source, {.resolution = 40});
    EXPECT_LT(density.metadata.closureError, 1e-4);
    EXPECT_NEAR(densityIntegral(*density.grid), source->volume(), 1e-5);
}

TEST(HeightFieldSource, PatchesFaceOutward) {
    const BsplineSurface surface = fitSurface(sampled(franke33(), bump)).sum();
    const auto source = makeHeightFieldSource("bump", surface, heightBelow(surface, 0.5));
    SurfaceQuadrature quadrature;
    quadrature.cellSide.back() = 4;  // by the rule of most points alone
    const openvdb::Vec3d low = source->bounds().min() / 0.02 - openvdb::Vec3d(1);
    const SamplingRegion region{0.02, low, openvdb::Vec3d(200)};
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < source->elementCount(); ++i) {
        source->sampleElement(i, region, quadrature, samples);
    }
    openvdb::Vec3d sum(0);
    double volume = 0;
    double area = 0;
    for (const SurfaceSample& sample : samples) {
        sum += openvdb::Vec3d(sample.areaVector);
        volume += openvdb::Vec3d(sample.position).dot(openvdb::Vec3d(sample.areaVector)) / 3;
        area += sample.areaVector.length();
    }
    const double cube = 0.02 * 0.02 * 0.02;
    EXPECT_NEAR(sum.length() / area, 0, 1e-6);
    EXPECT_NEAR(volume * cube, source->volume(), 1e-6 * source->volume());
    EXPECT_NEAR(area * 0.02 * 0.02, source->area(), 1e-6 * source->area());
}

TEST(HeightFieldSource, RefusesABaseInTheSurface) {
    const BsplineSurface surface = fitSurface(sampled(franke33(), bump)).sum();
    EXPECT_THROW(makeHeightFieldSource("bump", surface, 0.1), Error);
}

TEST(HeightFieldSource, TakesABaseBelowTheSurfaceButNotBelowItsOrdinates) {
    // One cell, a parabola that goes down to 0 in the middle; ordinates go down to -1/3.
    BsplineSurface surface({0, 0, 1, 1}, {1, 1}, 1);
    const std::array<double, 4> along{23.0 / 3, -1.0 / 3, -1.0 / 3, 23.0 / 3};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) surface.control(0)[4 * i + j] = along[i];
    }
    ASSERT_NEAR(surface.value(0.5, 0.3), 0, 1e-12);
    const auto ordinates = surface.bezierOrdinates(0, 0);
    EXPECT_LT(*std::min_element(ordinates.begin(), ordinates.end()), -0.1);
    EXPECT_NO_THROW(makeHeightFieldSource("valley", surface, -0.01));
    EXPECT_THROW(makeHeightFieldSource("valley", surface, 0.01), Error);
}

}  // namespace
}  // namespace bandvox

#include "compare/test_surfaces.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/compare/grid_to_surface.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox::compare_test {
namespace {

using openvdb::Vec3d;

constexpr double kPi = 3.14159265358979323846;

openvdb::FloatGrid::Ptr sphereLevelSet(double radius, double voxel,
                                       const Vec3d& center = Vec3d(0)) {
    return levelSet([=](const Vec3d& p) { return (p - center).length() - radius; }, 1.6, voxel);
}

TEST(GridToSurface, PointsLieOnASphereAndDeviationIsWhatTheTrianglesSag) {
    double before = 0;
    for (const int cuts : {0, 1, 2}) {
        const SurfaceOfGrid found = gridToSurface(sphereLevelSet(1, 0.1), {.cuts = cuts});
        EXPECT_EQ(found.iso, 0);
        EXPECT_NEAR(found.voxel, 0.1, 1e-12);
        const ComparedSurface& surface = found.surface;
        ASSERT_EQ(surface.normals.size(), surface.mesh.points.size());
        double off = 0, turned = 0, sag = 0;
        for (std::size_t i = 0; i < surface.normals.size(); ++i) {
            const Vec3d& p = surface.mesh.points[i];
            off = std::max(off, std::abs(p.length() - 1));
            turned = std::max(turned, (Vec3d(surface.normals[i]) - p / p.length()).length());
        }
        for (const openvdb::Vec3I& t : surface.mesh.triangles) {
            const Vec3d middle = (surface.mesh.points[t[0]] + surface.mesh.points[t[1]] +
                                  surface.mesh.points[t[2]]) /
                                 3.0;
            sag = std::max(sag, std::abs(middle.length() - 1));
        }
        EXPECT_LT(off, 5e-5);
        EXPECT_LT(turned, 1e-3);
        EXPECT_NEAR(surface.deviation, sag, 4e-5);
        if (cuts > 0) {
            // Triangles of half the size sag a quarter as much.
            EXPECT_NEAR(surface.deviation, before / 4, 0.12 * before);
        }
        before = surface.deviation;
        // Of the mesh that was not cut.
        EXPECT_NEAR(found.volume, 4 * kPi / 3, 0.04);
        EXPECT_LT(found.volume, 4 * kPi / 3);
    }
}

TEST(GridToSurface, DistancesOfLevelSetsAreThoseOfTheirForms) {
    const SurfaceOfGrid a = gridToSurface(sphereLevelSet(1, 0.08));
    const SurfaceOfGrid inside = gridToSurface(sphereLevelSet(0.8, 0.05));
    const SurfaceOfGrid shifted = gridToSurface(sphereLevelSet(1, 0.07, Vec3d(0.2, 0.1, 0)));
    const double tolerance = 2e-3;
    const SurfaceDifference smaller =
        compareSurfaces(a.surface, inside.surface, {.tolerance = tolerance});
    EXPECT_NEAR(smaller.hausdorff, 0.2, a.surface.deviation + inside.surface.deviation + 2e-5);
    EXPECT_GE(smaller.hausdorffAtMost, 0.2 - 2e-5);
    EXPECT_LE(smaller.hausdorffAtMost,
              0.2 + tolerance + 2 * (a.surface.deviation + inside.surface.deviation) + 2e-5);
    EXPECT_NEAR(smaller.meanDistance, 0.2, 3e-4);
    EXPECT_LT(smaller.angles.maximum, 0.5);
    const SurfaceDifference moved =
        compareSurfaces(a.surface, shifted.surface, {.tolerance = tolerance});
    EXPECT_NEAR(moved.hausdorff, std::sqrt(0.05), 2e-3);
}

// Where the density of a ball of radius 1 is 0.5 under the filter exp(-(k/cutoff)²) of a lattice.
double radiusOfHalf(double cutoff, double voxel) {
    const double sigma = voxel / (std::sqrt(2.0) * kPi * cutoff);
    const auto density = [sigma](double r) {
        const double below = (1 - r) / sigma, above = (1 + r) / sigma;
        return 0.5 * (std::erf(below / std::sqrt(2.0)) + std::erf(above / std::sqrt(2.0))) -
               sigma / (r * std::sqrt(2 * kPi)) *
                   (std::exp(-below * below / 2) - std::exp(-above * above / 2));
    };
    double low = 0.8, high = 1.2;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (density(middle) > 0.5 ? low : high) = middle;
    }
    return low;
}

TEST(GridToSurface, ASphereShrinksByWhatItsFilterDoes) {
    const auto source = makeShapeBoundary("shape:sphere");
    DensityOptions options;
    options.resolution = 24;
    const auto coarse = surfaceToDensity(*source, options).grid;
    options.resolution = 41;
    const auto fine = surfaceToDensity(*source, options).grid;
    const SurfaceOfGrid a = gridToSurface(coarse), b = gridToSurface(fine);
    EXPECT_EQ(a.iso, 0.5);
    const double expected = radiusOfHalf(options.filter.cutoff, 2.0 / 41) -
                            radiusOfHalf(options.filter.cutoff, 2.0 / 24);
    EXPECT_GT(expected, 5e-3);
    const double tolerance = 0.05 * a.voxel;
    const SurfaceDifference found = compareSurfaces(a.surface, b.surface, {.tolerance = tolerance});
    const double deviation = a.surface.deviation + b.surface.deviation;
    EXPECT_NEAR(found.hausdorff, expected, deviation + 1e-4);
    EXPECT_GE(found.hausdorffAtMost, expected - 1e-4);
    EXPECT_LE(found.hausdorffAtMost, expected + 2 * deviation + tolerance + 1e-4);
    EXPECT_NEAR(found.meanDistance, expected, 4e-4);
    EXPECT_LT(found.angles.maximum, 1);
}

TEST(GridToSurface, RefusesWhatHasNoSurface) {
    const auto kindOf = [](const openvdb::FloatGrid::ConstPtr& grid,
                           const GridToSurfaceOptions& options = {}) {
        try {
            gridToSurface(grid, options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Interrupted;
    };
    const auto grid = sphereLevelSet(1, 0.2);
    EXPECT_EQ(kindOf(grid), ErrorKind::Interrupted) << "this one works";
    EXPECT_EQ(kindOf(nullptr), ErrorKind::Usage);
    EXPECT_EQ(kindOf(grid, {.cuts = 4}), ErrorKind::Usage);
    EXPECT_EQ(kindOf(grid, {.cuts = -1}), ErrorKind::Usage);
    EXPECT_EQ(kindOf(grid, {.iso = 100}), ErrorKind::Usage);
    EXPECT_EQ(kindOf(grid, {.iso = -3}), ErrorKind::Result);
    EXPECT_EQ(kindOf(openvdb::FloatGrid::create(0.0F)), ErrorKind::Input);
}

}  // namespace
}  // namespace bandvox::compare_test

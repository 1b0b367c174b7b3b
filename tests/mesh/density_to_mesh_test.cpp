#include "mesh/mesh_checks.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace bandvox::mesh_test {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3f;

DensityResult shapeDensity(const std::string& name, int resolution) {
    DensityOptions options;
    options.resolution = resolution;
    options.tolerance = 1e-5;
    DensityResult result = surfaceToDensity(*makeShapeBoundary("shape:" + name), options);
    setDensityMetadata(*result.grid, result.metadata);
    return result;
}

DensityMetadata filtered(double order, double cutoff) {
    DensityMetadata metadata;
    metadata.order = order;
    metadata.cutoff = cutoff;
    metadata.tolerance = 1e-5;
    return metadata;
}

/// The farthest point of a mesh from the surface, voxels, as value over slope tell; and the largest
/// angle between a normal and the gradient, radians. For densities.
struct Deviation {
    double distance = 0, angle = 0;
};

Deviation deviation(const SurfaceMesh& surface, const openvdb::FloatGrid& grid,
                    const Reconstruction& field, double iso) {
    Deviation worst;
    const auto probe = field.probe();
    for (std::size_t i = 0; i < surface.mesh.points.size(); ++i) {
        const DensityAt at = probe->evaluate(grid.worldToIndex(surface.mesh.points[i]));
        worst.distance = std::max(worst.distance, std::abs(at.value - iso) / at.gradient.length());
        const Vec3d outward = -grid.transform().baseMap()->applyIJT(at.gradient).unit();
        const double cosine = std::clamp(outward.dot(Vec3d(surface.normals[i])), -1.0, 1.0);
        worst.angle = std::max(worst.angle, std::acos(cosine));
    }
    return worst;
}

TEST(DensityToMesh, BallIsRound) {
    const DensityResult density = shapeDensity("sphere", 40);
    const MeshResult result = densityToMesh(density.grid);
    const Mesh& mesh = result.surface.mesh;
    EXPECT_EQ(flaw(mesh), "");
    EXPECT_EQ(eulerNumber(mesh), 2);
    EXPECT_EQ(result.iso, 0.5);
    EXPECT_TRUE(result.surface.colors.empty());
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(meetings(mesh), 0u);
    // The level 0.5 of a smoothed ball lies a little inside: by σ²/r, σ = 1/(√2 π k_c·2) voxels.
    const double voxel = density.grid->voxelSize()[0];
    const double sigma = 1 / (std::numbers::sqrt2 * std::numbers::pi * 0.16) * voxel;
    const double radius = 1 - sigma * sigma;
    double least = 2, most = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const double r = mesh.points[i].length();
        least = std::min(least, r);
        most = std::max(most, r);
        EXPECT_GT(Vec3d(result.surface.normals[i]).dot(mesh.points[i]) / r, 1 - 1e-5);
        EXPECT_NEAR(result.surface.normals[i].length(), 1, 1e-6);
    }
    EXPECT_LT(most - least, 1.5e-3 * voxel);
    EXPECT_NEAR(0.5 * (most + least), radius, 0.01 * voxel);
    // Triangles cut the ball's corners: by h²/8r on the average, h their size.
    EXPECT_NEAR(enclosedVolume(mesh) / (4.0 / 3 * std::numbers::pi * std::pow(most, 3)), 1, 2e-3);
    EXPECT_GT(enclosedVolume(mesh), 0);
}

TEST(DensityToMesh, ShapesAreClosedAndAccurate) {
    struct Shape {
        const char* name;
        long euler;
    };
    for (const Shape& shape : {Shape{"cube", 2}, Shape{"torus", 0}, Shape{"two-balls", 2},
                               Shape{"hyperboloid", 2}, Shape{"tree", 2}}) {
        SCOPED_TRACE(shape.name);
        const DensityResult density = shapeDensity(shape.name, 48);
        const MeshResult result = densityToMesh(density.grid);
        const Mesh& mesh = result.surface.mesh;
        EXPECT_EQ(flaw(mesh), "");
        EXPECT_EQ(meetings(mesh), 0u);
        if (std::string(shape.name) != "tree" && std::string(shape.name) != "two-balls") {
            EXPECT_EQ(eulerNumber(mesh), shape.euler);
        }
        const auto field = makeBrickReconstruction(
            density.grid, {{density.metadata.order, density.metadata.cutoff}, 1.5e-5});
        const Deviation worst = deviation(result.surface, *density.grid, *field, 0.5);
        EXPECT_LT(worst.distance, 1e-3);
        EXPECT_LT(worst.angle, 1e-2);
        printf(
            "%s: %zu points %zu triangles %zu ambiguous, distance %g angle %g volume %g of %g "
            "pieces %zu euler %ld\n",
            shape.name, mesh.points.size(), mesh.triangles.size(), result.ambiguousFaces,
            worst.distance, worst.angle, enclosedVolume(mesh), density.metadata.gridVolume,
            pieces(mesh), eulerNumber(mesh));
    }
}

TEST(DensityToMesh, RandomWavesAreManifoldWhateverTheCells) {
    std::size_t ambiguous = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        for (const double highest : {0.2, 0.45, 0.8}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", up to " << highest);
            const RandomWaves waves(seed, highest, 14);
            const auto grid = sampled(24, waves);
            MeshOptions options;
            options.iso = 0.1;
            for (const bool isFiltered : {false, true}) {
                if (isFiltered) {
                    if (highest > 0.5) continue;
                    setDensityMetadata(*grid, filtered(2, 0.16));
                }
                const MeshResult result = densityToMesh(grid, options);
                EXPECT_EQ(flaw(result.surface.mesh), "");
                EXPECT_GT(enclosedVolume(result.surface.mesh), 0);
                ambiguous += result.ambiguousFaces;
                printf(
                    "seed %u highest %g: %zu triangles, %zu ambiguous faces of %zu cells, meetings "
                    "%zu\n",
                    seed, highest, result.surface.mesh.triangles.size(), result.ambiguousFaces,
                    result.cells, meetings(result.surface.mesh));
            }
        }
    }
    EXPECT_GT(ambiguous, 1000u);
}

}  // namespace
}  // namespace bandvox::mesh_test

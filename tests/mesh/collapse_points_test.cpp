#include "mesh/collapse_points.h"

#include "mesh/mesh_checks.h"

#include <bandvox/mesh/density_to_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace bandvox::mesh_test {
namespace {

using openvdb::Vec3d;

openvdb::FloatGrid::Ptr roundedBox() {
    return sampled(26, [](const Vec3d& x) {
        const Vec3d beyond(std::max(std::abs(x[0]) - 16, 0.0), std::max(std::abs(x[1]) - 13, 0.0),
                           std::max(std::abs(x[2]) - 10, 0.0));
        return 1 / (1 + std::exp(2 * (beyond.length() - 4)));
    });
}

// The largest distance from points and middles of triangles of one mesh to another one, of some.
double farthest(const Mesh& from, const Mesh& to) {
    const MeshDistance distance(to);
    double worst = 0;
    for (std::size_t t = 0; t < from.triangles.size(); t += 3) {
        Vec3d middle(0.0);
        for (int k = 0; k < 3; ++k) {
            const Vec3d& corner = from.points[from.triangles[t][k]];
            worst = std::max(worst, distance(corner));
            middle += corner / 3;
        }
        worst = std::max(worst, distance(middle));
    }
    return worst;
}

TEST(CollapsePoints, StaysWithinTheTolerance) {
    const auto grid = roundedBox();
    const MeshResult all = densityToMesh(grid);
    std::size_t before = all.surface.mesh.points.size();
    for (const double adaptivity : {0.02, 0.1, 0.4, 1.0}) {
        SCOPED_TRACE(adaptivity);
        const MeshResult some = densityToMesh(grid, {.adaptivity = adaptivity});
        const Mesh& mesh = some.surface.mesh;
        EXPECT_EQ(flaw(mesh), "");
        EXPECT_EQ(eulerNumber(mesh), 2);
        EXPECT_EQ(meetings(mesh), 0u);
        EXPECT_EQ(some.pointsCollapsed + mesh.points.size(), all.surface.mesh.points.size());
        EXPECT_LE(mesh.points.size(), before);
        before = mesh.points.size();
        EXPECT_LT(farthest(mesh, all.surface.mesh), 0.25 * adaptivity);
        EXPECT_LT(farthest(all.surface.mesh, mesh), 0.25 * adaptivity);
        EXPECT_NEAR(some.volume / all.volume, 1, 0.01 * adaptivity);
    }
    // Flat sides need few.
    EXPECT_LT(before, all.surface.mesh.points.size() / 8);
}

TEST(CollapsePoints, WhatStaysIsWhatItWas) {
    const auto grid = roundedBox();
    const MeshResult all = densityToMesh(grid);
    const MeshResult some = densityToMesh(grid, {.adaptivity = 0.5});
    std::map<Vec3d, openvdb::Vec3f> normals;
    for (std::size_t i = 0; i < all.surface.mesh.points.size(); ++i) {
        normals[all.surface.mesh.points[i]] = all.surface.normals[i];
    }
    for (std::size_t i = 0; i < some.surface.mesh.points.size(); ++i) {
        const auto found = normals.find(some.surface.mesh.points[i]);
        ASSERT_TRUE(found != normals.end());
        EXPECT_EQ(found->second, some.surface.normals[i]);
    }
    // No triangle is turned away from the surface.
    for (const openvdb::Vec3I& t : some.surface.mesh.triangles) {
        const auto& p = some.surface.mesh.points;
        const Vec3d normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
        for (int k = 0; k < 3; ++k) {
            EXPECT_GT(normal.dot(Vec3d(some.surface.normals[t[k]])), 0);
        }
    }
}

TEST(CollapsePoints, ManifoldWhateverTheSurface) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        for (const double highest : {0.1, 0.3, 0.7}) {
            for (const double adaptivity : {0.1, 1.0}) {
                SCOPED_TRACE(testing::Message()
                             << seed << ", up to " << highest << ", adaptivity " << adaptivity);
                const auto grid = sampled(20, RandomWaves(seed, highest, 12));
                const MeshResult all = densityToMesh(grid, {.iso = 0.1});
                const MeshResult some = densityToMesh(grid, {.iso = 0.1, .adaptivity = adaptivity});
                EXPECT_EQ(flaw(some.surface.mesh), "");
                EXPECT_EQ(eulerNumber(some.surface.mesh), eulerNumber(all.surface.mesh));
                EXPECT_EQ(pieces(some.surface.mesh), pieces(all.surface.mesh));
                EXPECT_GT(some.pointsCollapsed, 0u);
            }
        }
    }
}

TEST(CollapsePoints, RegionsMeetWithoutATrace) {
    // As in one region, whatever their size: about as many points are left.
    const MeshResult all = densityToMesh(roundedBox());
    std::size_t whole = 0;
    for (const double side : {1000.0, 12.0, 5.0}) {
        SurfaceMesh surface = all.surface;
        const std::size_t removed = collapsePoints(surface, {0.1, side}, silentProgress());
        EXPECT_EQ(flaw(surface.mesh), "") << side;
        EXPECT_EQ(removed + surface.mesh.points.size(), all.surface.mesh.points.size());
        if (side == 1000.0) {
            whole = surface.mesh.points.size();
        } else if (side == 12.0) {
            EXPECT_LT(surface.mesh.points.size(), 3 * whole);
        }
    }
}

TEST(CollapsePoints, SmallestMeshesStay) {
    SurfaceMesh surface;
    surface.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    surface.mesh.triangles = {openvdb::Vec3I(0, 2, 1), openvdb::Vec3I(0, 1, 3),
                              openvdb::Vec3I(0, 3, 2), openvdb::Vec3I(1, 2, 3)};
    for (const Vec3d& p : surface.mesh.points) {
        surface.normals.emplace_back((p - Vec3d(0.25)).unit());
    }
    EXPECT_EQ(collapsePoints(surface, {100, 100}, silentProgress()), 0u);
    EXPECT_EQ(flaw(surface.mesh), "");
}

}  // namespace
}  // namespace bandvox::mesh_test

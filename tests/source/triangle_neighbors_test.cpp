#include "source/triangle_neighbors.h"

#include "source/no_index.h"
#include "source/test_meshes.h"

#include <bandvox/core/parallel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

TriangleNeighbors neighborsOf(const Mesh& mesh) {
    const DirectedEdges edges(mesh);
    return findNeighbors(edges, listEdges(edges, mesh.points.size()));
}

// Many balls, the triangles of all in disorder.
Mesh shuffledBalls() {
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
        test::append(mesh, test::sphere(Vec3d(3 * i, 0, 0), 1, 12, 30 + static_cast<unsigned>(i)));
    }
    std::mt19937 random(2);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    return mesh;
}

TEST(TriangleNeighbors, OfBallsAreTheirSetsForAnyNumberOfThreads) {
    const Mesh mesh = shuffledBalls();
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        const TriangleNeighbors neighbors = neighborsOf(mesh);
        EXPECT_TRUE(neighbors.agree);
        EXPECT_EQ(neighbors.crowdedEdges, 0U);
        const DirectedEdges edges(mesh);
        for (std::uint32_t e = 0; e < edges.count(); ++e) {
            ASSERT_NE(neighbors.mate[e], kNoIndex);
            ASSERT_EQ(edges.from(neighbors.mate[e]), edges.to(e));
            ASSERT_EQ(edges.to(neighbors.mate[e]), edges.from(e));
        }
        // The balls lie apart, so where a triangle is tells its ball; the first to come is 0.
        const ConnectedTriangles sets = connectNeighbors(neighbors);
        EXPECT_EQ(sets.count, 40U);
        std::vector<std::uint32_t> ofBall(40, kNoIndex);
        std::uint32_t known = 0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto ball =
                static_cast<std::size_t>(mesh.points[mesh.triangles[t][0]].x() / 3 + 0.5);
            if (ofBall[ball] == kNoIndex) ofBall[ball] = known++;
            ASSERT_EQ(sets.setOf[t], ofBall[ball]);
        }
    }
}

TEST(TriangleNeighbors, DisagreeWhereOneIsTurned) {
    Mesh mesh = test::cube(Vec3d(0.0), 1);
    EXPECT_TRUE(neighborsOf(mesh).agree);
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    EXPECT_FALSE(neighborsOf(mesh).agree);
}

TEST(TriangleNeighbors, AreNoneAcrossEdgesOfOneOrThree) {
    Mesh mesh;
    for (int i = 0; i < 5; ++i) mesh.points.emplace_back(i, i * i, i * i * i);
    mesh.triangles = {Vec3I(0, 1, 2), Vec3I(1, 0, 3), Vec3I(0, 1, 4)};
    const TriangleNeighbors neighbors = neighborsOf(mesh);
    EXPECT_EQ(neighbors.crowdedEdges, 1U);
    EXPECT_EQ(std::count(neighbors.mate.begin(), neighbors.mate.end(), kNoIndex), 9);
    EXPECT_EQ(connectNeighbors(neighbors).count, 3U);
}

}  // namespace
}  // namespace bandvox

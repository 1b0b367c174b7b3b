// What judges meshes, judged.

#include "mesh/mesh_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace bandvox::mesh_test {
namespace {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {openvdb::Vec3I(0, 2, 1), openvdb::Vec3I(0, 1, 3), openvdb::Vec3I(0, 3, 2),
                      openvdb::Vec3I(1, 2, 3)};
    return mesh;
}

TEST(MeshChecks, FindWhatIsWrong) {
    EXPECT_EQ(flaw(tetrahedron()), "");
    EXPECT_DOUBLE_EQ(enclosedVolume(tetrahedron()), 1.0 / 6);
    EXPECT_EQ(eulerNumber(tetrahedron()), 2);
    Mesh open = tetrahedron();
    open.triangles.pop_back();
    EXPECT_NE(flaw(open), "");
    Mesh turned = tetrahedron();
    std::swap(turned.triangles[1][0], turned.triangles[1][1]);
    EXPECT_NE(flaw(turned), "");
    Mesh flat = tetrahedron();
    flat.triangles[2][1] = flat.triangles[2][0];
    EXPECT_NE(flaw(flat), "");
    Mesh lonely = tetrahedron();
    lonely.points.emplace_back(2, 2, 2);
    EXPECT_NE(flaw(lonely), "");
    // Two that share a corner.
    Mesh touching = tetrahedron();
    for (const openvdb::Vec3d& p : tetrahedron().points) {
        if (p.length() > 0) touching.points.push_back(-p);
    }
    for (const openvdb::Vec3I& t : tetrahedron().triangles) {
        const auto moved = [](unsigned i) { return i == 0 ? 0 : i + 3; };
        touching.triangles.emplace_back(moved(t[0]), moved(t[2]), moved(t[1]));
    }
    EXPECT_NE(flaw(touching).find("more than one fan"), std::string::npos);
    EXPECT_EQ(pieces(touching), 1u);
}

TEST(MeshChecks, MeasureDistances) {
    const Mesh mesh = tetrahedron();
    const MeshDistance distance(mesh);
    EXPECT_DOUBLE_EQ(distance({0.1, 0.2, -3}), 3);
    EXPECT_DOUBLE_EQ(distance({-3, 0, -4}), 5);
    EXPECT_NEAR(distance({0.05, 0.2, 0.2}), 0.05, 1e-12);
    EXPECT_NEAR(distance({1, 1, 1}), 2 / std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace bandvox::mesh_test

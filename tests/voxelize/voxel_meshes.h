#pragma once

#include "source/test_meshes.h"

#include <bandvox/voxelize/voxels.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

// Meshes that are hard to voxelize, and how voxels are compared.
namespace bandvox::test {

/// Turned about all axes by angles that are nothing special.
inline Mesh turned(Mesh mesh) {
    for (openvdb::Vec3d& p : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            const double angle = 0.37 + 0.21 * axis;
            double &u = p[(axis + 1) % 3], &v = p[(axis + 2) % 3];
            const double turnedU = std::cos(angle) * u - std::sin(angle) * v;
            v = std::sin(angle) * u + std::cos(angle) * v;
            u = turnedU;
        }
    }
    return mesh;
}

/// Points scaled along each axis, then moved.
inline Mesh placed(Mesh mesh, const openvdb::Vec3d& scale, const openvdb::Vec3d& shift) {
    for (openvdb::Vec3d& p : mesh.points) p = p * scale + shift;
    return mesh;
}

/// Points rounded to whole numbers of 1 / `parts`.
inline Mesh snapped(Mesh mesh, double parts) {
    for (openvdb::Vec3d& p : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * parts) / parts;
    }
    return mesh;
}

inline Mesh octahedron(const openvdb::Vec3d& center, double radius) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {radius, -radius}) {
            mesh.points.push_back(center);
            mesh.points.back()[axis] += side;
        }
    }
    for (unsigned i = 0; i < 8; ++i) {
        const unsigned x = i & 1, y = i >> 1 & 1, z = i >> 2;
        mesh.triangles.emplace_back(x, 2 + y, 4 + z);
        if ((x + y + z) % 2 == 1) {
            std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
        }
    }
    return mesh;
}

/// A torus about the z axis.
inline Mesh torus(double radius, double tube, unsigned around, unsigned across) {
    Mesh mesh;
    for (unsigned i = 0; i < around; ++i) {
        const double a = 2 * std::numbers::pi * i / around;
        for (unsigned j = 0; j < across; ++j) {
            const double b = 2 * std::numbers::pi * j / across;
            const double r = radius + tube * std::cos(b);
            mesh.points.emplace_back(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
        }
    }
    const auto at = [=](unsigned i, unsigned j) { return i % around * across + j % across; };
    for (unsigned i = 0; i < around; ++i) {
        for (unsigned j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

struct NamedMesh {
    std::string name;
    Mesh mesh;  ///< in voxels
};

/// Closed meshes, wound around once at most.
inline std::vector<NamedMesh> hardMeshes() {
    using openvdb::Vec3d;
    const Mesh ball = sphere(Vec3d(0.3, -0.2, 0.1), 9, 14, 20);
    return {
        {"turned cube", placed(turned(cube(Vec3d(-9), 18)), Vec3d(1), Vec3d(0.3, 7.7, -4.1))},
        {"cube on voxel centres", cube(Vec3d(-3, 1, 5), 13)},
        {"cube on sub-samples", cube(Vec3d(-3.25, 1.25, 5.75), 13.5)},
        {"cube on block borders", cube(Vec3d(-8, 8, 16), 24)},
        {"octahedron on centres", octahedron(Vec3d(1, -2, 3), 11)},
        {"octahedron on sub-samples", octahedron(Vec3d(1.25, -2.25, 3.75), 10.5)},
        {"tetrahedron on centres", tetrahedron(Vec3d(-4, 0, 2), 17)},
        {"ball", ball},
        {"ball of points on centres", snapped(ball, 1)},
        {"ball of points on halves", snapped(ball, 2)},
        {"ball of points on sub-samples", snapped(ball, 4)},
        {"fine ball", sphere(Vec3d(0.5), 7, 80, 120)},
        {"fine ball of points on centres", snapped(sphere(Vec3d(0.5), 6, 40, 60), 1)},
        {"torus", turned(torus(14, 5, 40, 20))},
        {"sliver", placed(turned(placed(cube(Vec3d(-0.5), 1), Vec3d(90, 0.7, 0.03), Vec3d(0.0))),
                          Vec3d(1), Vec3d(3.1, 2.2, 1.3))},
        {"long thin tetrahedron",
         placed(tetrahedron(Vec3d(0.0), 1), Vec3d(120, 2, 3), Vec3d(-40, 0, 0))},
        {"plate on voxel centres", placed(cube(Vec3d(0.0), 1), Vec3d(60, 1, 40), Vec3d(-30, 4, 2))},
        {"one voxel", cube(Vec3d(0.7), 0.6)},
    };
}

/// Expects two grids to have the same voxels, values and places.
inline void expectSameVoxels(const VoxelResult& a, const VoxelResult& b) {
    EXPECT_EQ(a.voxels, b.voxels);
    EXPECT_EQ(a.volume, b.volume);
    EXPECT_EQ(a.warnings, b.warnings);
    ASSERT_TRUE(a.grid && b.grid);
    ASSERT_TRUE(a.grid->tree().hasSameTopology(b.grid->tree()));
    const auto values = b.grid->getConstAccessor();
    for (auto value = a.grid->cbeginValueOn(); value; ++value) {
        ASSERT_EQ(values.getValue(value.getCoord()), *value) << value.getCoord();
    }
}

}  // namespace bandvox::test

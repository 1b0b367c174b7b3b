#include "compare/test_surfaces.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace bandvox::compare_test {

using openvdb::Vec3d;

namespace {

// The cube [-1, 1]³; points of neighbouring faces are there twice.
Mesh gridCube(int squares) {
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double sign = face % 2 == 0 ? 1 : -1;
        const auto first = static_cast<unsigned>(mesh.points.size());
        const auto row = static_cast<unsigned>(squares + 1);
        for (int i = 0; i <= squares; ++i) {
            for (int j = 0; j <= squares; ++j) {
                Vec3d p;
                p[axis] = sign;
                // Seen from outside, u turns to v counter-clockwise.
                p[(axis + 1) % 3] = sign * (2.0 * i / squares - 1);
                p[(axis + 2) % 3] = 2.0 * j / squares - 1;
                mesh.points.push_back(p);
            }
        }
        for (unsigned i = 0; i + 1 < row; ++i) {
            for (unsigned j = 0; j + 1 < row; ++j) {
                const unsigned a = first + i * row + j, b = a + row;
                mesh.triangles.emplace_back(a, b, b + 1);
                mesh.triangles.emplace_back(a, b + 1, a + 1);
            }
        }
    }
    return mesh;
}

}  // namespace

Mesh sphere(const Vec3d& center, double radius, int squares) {
    Mesh mesh = gridCube(squares);
    for (Vec3d& p : mesh.points) p = center + p * (radius / p.length());
    return mesh;
}

Mesh roundedCube(double radius, int squares) {
    Mesh mesh = gridCube(squares);
    const double inner = 1 - radius;
    for (Vec3d& p : mesh.points) {
        Vec3d core;
        for (int axis = 0; axis < 3; ++axis) core[axis] = std::clamp(p[axis], -inner, inner);
        const Vec3d out = p - core;
        if (radius > 0) p = core + out * (radius / out.length());
    }
    return mesh;
}

Mesh torus(double major, double minor, int points) {
    Mesh mesh;
    const auto count = static_cast<unsigned>(points);
    for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
            const double u = 2 * openvdb::math::pi<double>() * i / points;
            const double v = 2 * openvdb::math::pi<double>() * j / points;
            const double reach = major + minor * std::cos(v);
            mesh.points.emplace_back(reach * std::cos(u), reach * std::sin(u), minor * std::sin(v));
        }
    }
    for (unsigned i = 0; i < count; ++i) {
        for (unsigned j = 0; j < count; ++j) {
            const unsigned next = (i + 1) % count * count, here = i * count, k = (j + 1) % count;
            mesh.triangles.emplace_back(here + j, next + j, next + k);
            mesh.triangles.emplace_back(here + j, next + k, here + k);
        }
    }
    return mesh;
}

Mesh joined(const Mesh& a, const Mesh& b) {
    Mesh mesh = a;
    const auto first = static_cast<unsigned>(a.points.size());
    mesh.points.insert(mesh.points.end(), b.points.begin(), b.points.end());
    for (const openvdb::Vec3I& t : b.triangles) {
        mesh.triangles.emplace_back(t[0] + first, t[1] + first, t[2] + first);
    }
    return mesh;
}

openvdb::FloatGrid::Ptr levelSet(const std::function<double(const Vec3d&)>& distance, double half,
                                 double voxel) {
    auto grid = openvdb::FloatGrid::create(static_cast<float>(half));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("surface");
    const int reach = static_cast<int>(std::ceil(half / voxel));
    auto accessor = grid->getAccessor();
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                const openvdb::Coord at(x, y, z);
                const double value = std::min(distance(at.asVec3d() * voxel), half);
                accessor.setValue(at, static_cast<float>(value));
            }
        }
    }
    return grid;
}

}  // namespace bandvox::compare_test

#pragma once

#include "test_meshes.h"

#include <random>

// Triangles that enclose something together, but that no caps close one by one.
namespace bandvox::test {

/// The faces of the cube [-1, 1]³ as six panels that do not touch: they end `gap` before the edges.
inline Mesh panels(double gap) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<openvdb::Index32>(mesh.points.size());
            for (int corner = 0; corner < 4; ++corner) {
                openvdb::Vec3d p;
                p[axis] = side;
                p[(axis + 1) % 3] = (corner == 1 || corner == 2 ? 1 : -1) * (1 - gap);
                p[(axis + 2) % 3] = (corner >= 2 ? 1 : -1) * (1 - gap);
                mesh.points.push_back(p);
            }
            const unsigned b = side > 0 ? 1 : 2, c = side > 0 ? 2 : 1;
            const unsigned d = side > 0 ? 2 : 3, e = side > 0 ? 3 : 2;
            mesh.triangles.emplace_back(first, first + b, first + c);
            mesh.triangles.emplace_back(first, first + d, first + e);
        }
    }
    return mesh;
}

/// Every triangle for itself, smaller by a part of its size.
inline Mesh shredded(const Mesh& mesh, double part) {
    Mesh result = soup(mesh);
    for (const openvdb::Vec3I& t : result.triangles) {
        const openvdb::Vec3d middle =
            (result.points[t[0]] + result.points[t[1]] + result.points[t[2]]) / 3.0;
        for (int k = 0; k < 3; ++k) {
            result.points[t[k]] += part * (middle - result.points[t[k]]);
        }
    }
    return result;
}

/// Without a part of its triangles, chosen at random.
inline Mesh thinned(Mesh mesh, double part, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<> uniform(0, 1);
    std::erase_if(mesh.triangles, [&](const openvdb::Vec3I&) { return uniform(random) < part; });
    return mesh;
}

/// Turned, so that nothing lies along an axis.
inline Mesh askew(Mesh mesh) {
    for (openvdb::Vec3d& p : mesh.points) {
        p = openvdb::Vec3d(0.36 * p.x() + 0.48 * p.y() - 0.8 * p.z(), -0.8 * p.x() + 0.6 * p.y(),
                           0.48 * p.x() + 0.64 * p.y() + 0.6 * p.z());
    }
    return mesh;
}

}  // namespace bandvox::test

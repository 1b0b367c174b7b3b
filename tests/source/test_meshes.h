#pragma once

#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>

// Meshes that several tests build, and slow ways to judge one.
namespace bandvox::test {

inline void append(Mesh& mesh, const Mesh& other) {
    const auto offset = static_cast<openvdb::Index32>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (const openvdb::Vec3I& t : other.triangles) {
        mesh.triangles.emplace_back(t[0] + offset, t[1] + offset, t[2] + offset);
    }
}

inline Mesh reversed(Mesh mesh) {
    for (openvdb::Vec3I& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

/// Triangles, segments and points, as they come.
inline Mesh soup(unsigned seed, int triangles) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 1);
    Mesh mesh;
    for (int i = 0; i < triangles; ++i) {
        const openvdb::Vec3d at(place(random), place(random), place(random));
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3d aside(place(random), place(random), place(random));
            mesh.points.push_back(at + 0.3 * aside);
        }
        const auto first = static_cast<unsigned>(3 * i);
        // Now and then a segment, or a point.
        if (i % 11 == 5) {
            mesh.triangles.emplace_back(first, first + 1, first);
        } else if (i % 11 == 7) {
            mesh.triangles.emplace_back(first, first, first);
        } else {
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
    }
    return mesh;
}

/// A cube, two triangles a face: 4·axis and 4·axis + 1 lie below, the next two above.
inline Mesh cube(const openvdb::Vec3d& corner, double side) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.points.push_back(corner + side * openvdb::Vec3d(i & 1, i >> 1 & 1, i >> 2));
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned a = 1u << (axis + 1) % 3;
        const unsigned b = 1u << (axis + 2) % 3;
        const unsigned up = 1u << axis;
        mesh.triangles.emplace_back(0, b, a + b);
        mesh.triangles.emplace_back(0, a + b, a);
        mesh.triangles.emplace_back(up, up + a, up + a + b);
        mesh.triangles.emplace_back(up, up + a + b, up + b);
    }
    return mesh;
}

inline Mesh tetrahedron(const openvdb::Vec3d& corner, double side) {
    Mesh mesh;
    mesh.points = {corner, corner + openvdb::Vec3d(side, 0, 0), corner + openvdb::Vec3d(0, side, 0),
                   corner + openvdb::Vec3d(0, 0, side)};
    mesh.triangles = {openvdb::Vec3I(0, 2, 1), openvdb::Vec3I(0, 1, 3), openvdb::Vec3I(0, 3, 2),
                      openvdb::Vec3I(1, 2, 3)};
    return mesh;
}

/// A sphere of rings and sectors, with triangles at the poles.
inline Mesh sphere(const openvdb::Vec3d& center, double radius, unsigned rings, unsigned sectors) {
    Mesh mesh;
    mesh.points.push_back(center - openvdb::Vec3d(0, radius, 0));
    for (unsigned i = 1; i < rings; ++i) {
        const double polar = std::numbers::pi * i / rings;
        for (unsigned j = 0; j < sectors; ++j) {
            const double angle = 2.0 * std::numbers::pi * j / sectors;
            mesh.points.push_back(center +
                                  radius * openvdb::Vec3d(std::sin(polar) * std::cos(angle),
                                                          -std::cos(polar),
                                                          std::sin(polar) * std::sin(angle)));
        }
    }
    mesh.points.push_back(center + openvdb::Vec3d(0, radius, 0));
    const auto last = static_cast<unsigned>(mesh.points.size() - 1);
    const auto at = [sectors](unsigned ring, unsigned sector) {
        return 1 + (ring - 1) * sectors + sector % sectors;
    };
    for (unsigned j = 0; j < sectors; ++j) {
        mesh.triangles.emplace_back(0, at(1, j), at(1, j + 1));
        mesh.triangles.emplace_back(last, at(rings - 1, j + 1), at(rings - 1, j));
        for (unsigned i = 1; i + 1 < rings; ++i) {
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

/// Each triangle with three points of its own.
inline Mesh soup(const Mesh& mesh) {
    Mesh result;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const auto first = static_cast<openvdb::Index32>(result.points.size());
        for (int k = 0; k < 3; ++k) result.points.push_back(mesh.points[t[k]]);
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

inline double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        sum += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]])) / 6.0;
    }
    return sum;
}

/// True if every directed edge occurs as often as its opposite.
inline bool isClosed(const Mesh& mesh) {
    std::map<std::pair<unsigned, unsigned>, int> net;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const unsigned a = t[k];
            const unsigned b = t[(k + 1) % 3];
            net[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    return std::all_of(net.begin(), net.end(), [](const auto& e) { return e.second == 0; });
}

inline bool hasWarning(const CloseMeshReport& report, const std::string& text) {
    return std::any_of(report.warnings.begin(), report.warnings.end(),
                       [&text](const std::string& w) { return w.find(text) != std::string::npos; });
}

}  // namespace bandvox::test

#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>

// A slow exact oracle for the scan conversion of meshes, along another axis than its own.
namespace bandvox::test {

/// Points are whole numbers of 1 / kParts voxels.
inline constexpr std::int64_t kParts = 4;

/// The sign of a + b ε + c ε² + d ε³ for small ε > 0.
inline int signOfSeries(const std::array<std::int64_t, 4>& terms) {
    for (const std::int64_t term : terms) {
        if (term != 0) return term > 0 ? 1 : -1;
    }
    return 0;
}

/// The winding number of a mesh, in voxels, about the place (x + ε, y + ε², z + ε³), for a small
/// ε, next to a voxel's centre: triangles above it along z, counted by orientation.
inline int exactWinding(const Mesh& mesh, const openvdb::Coord& voxel) {
    using Point = std::array<std::int64_t, 3>;
    const Point x{voxel.x() * kParts, voxel.y() * kParts, voxel.z() * kParts};
    int winding = 0;
    for (const openvdb::Vec3I& triangle : mesh.triangles) {
        std::array<Point, 3> p;
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                p[k][axis] =
                    std::llround(mesh.points[triangle[k]][axis] * static_cast<double>(kParts));
            }
        }
        // Does the line along z pass through it?
        int sides = 0;
        for (int k = 0; k < 3; ++k) {
            const Point &a = p[k], &b = p[(k + 1) % 3];
            const std::int64_t ux = b[0] - a[0], uy = b[1] - a[1];
            sides += signOfSeries({ux * (x[1] - a[1]) - uy * (x[0] - a[0]), -uy, ux, 0});
        }
        if (std::abs(sides) != 3) continue;
        // Is it above?
        const Point &a = p[0], &b = p[1], &c = p[2];
        const std::int64_t ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        const std::int64_t vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        const std::int64_t nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        const std::int64_t offset = nx * (x[0] - a[0]) + ny * (x[1] - a[1]) + nz * (x[2] - a[2]);
        const int up = nz > 0 ? 1 : -1;
        if (up * signOfSeries({offset, nx, ny, nz}) < 0) winding += up;
    }
    return winding;
}

}  // namespace bandvox::test

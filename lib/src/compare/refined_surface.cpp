#include "compare/refined_surface.h"

#include "mesh/triangle_tree.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {

namespace {

using openvdb::Vec3d;
using openvdb::Vec3f;

constexpr std::size_t kPointsPerTask = 4096;

// An edge, of which half comes from each of its triangles.
struct EdgeOfCorner {
    std::uint64_t key;     // both points, the smaller first
    std::uint32_t corner;  // 3 triangle + side

    bool operator<(const EdgeOfCorner& other) const {
        return std::pair(key, corner) < std::pair(other.key, other.corner);
    }
};

std::vector<EdgeOfCorner> sortedEdges(const Mesh& mesh) {
    std::vector<EdgeOfCorner> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const openvdb::Vec3I& t = mesh.triangles[i];
        for (int side = 0; side < 3; ++side) {
            const auto [low, high] = std::minmax({t[side], t[(side + 1) % 3]});
            edges.push_back({(std::uint64_t(low) << 32) | high,
                             static_cast<std::uint32_t>(3 * i + static_cast<std::size_t>(side))});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

template <typename Body>
void forSurface(std::size_t count, const char* what, const Reconstruction& field,
                Progress& progress, const Body& body) {
    const std::size_t tasks = (count + kPointsPerTask - 1) / kPointsPerTask;
    const ProgressStage stage(progress, what, static_cast<std::int64_t>(tasks));
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const auto probe = field.probe();
        const std::size_t begin = static_cast<std::size_t>(task) * kPointsPerTask;
        for (std::size_t i = begin; i < std::min(begin + kPointsPerTask, count); ++i) {
            body(i, *probe);
        }
        progress.advance();
    });
}

// Outward, of length 1; 0 where the field has no gradient.
Vec3f normalOf(const DensityAt& at, const openvdb::math::Transform& transform) {
    const Vec3d gradient = transform.baseMap()->applyIJT(at.gradient);
    const double length = gradient.length();
    return length > 0 ? Vec3f(-gradient / length) : Vec3f(0.0F);
}

// Newton's method along the gradient from a place near the surface. Where it does not lead there
// within a voxel, the place stays.
void bringOnto(const IsoSurface& surface, DensityProbe& probe, Vec3d& place, Vec3f& normal) {
    constexpr int kMostSteps = 8;
    constexpr double kNearEnough = 1e-6, kFarthest = 1;  // voxels
    const Vec3d start = surface.transform.worldToIndex(place);
    Vec3d index = start;
    DensityAt at = probe.evaluate(index);
    for (int step = 0; step < kMostSteps; ++step) {
        const double square = at.gradient.lengthSqr();
        if (!(square > 0)) return;
        const Vec3d move = at.gradient * ((surface.iso - at.value) / square);
        if ((index + move - start).length() > kFarthest) return;
        index += move;
        at = probe.evaluate(index);
        if (move.length() > kNearEnough) continue;
        place = surface.transform.indexToWorld(index);
        break;
    }
    const Vec3f found = normalOf(at, surface.transform);
    if (found.lengthSqr() > 0) normal = found;
}

}  // namespace

SurfaceMesh cutTriangles(const SurfaceMesh& coarse, const IsoSurface& surface, Progress& progress) {
    const Mesh& mesh = coarse.mesh;
    const std::size_t triangles = mesh.triangles.size(), points = mesh.points.size();
    constexpr double kBytesPerTriangle = 200;
    requireMemory(kBytesPerTriangle * static_cast<double>(triangles), "the surface to compare");
    if (triangles > std::numeric_limits<std::uint32_t>::max() / 12) {
        throw Error(ErrorKind::Memory, "a surface of " + std::to_string(triangles) +
                                           " triangles has too many to cut each into four");
    }

    SurfaceMesh fine;
    fine.mesh.points = mesh.points;
    fine.normals = coarse.normals;
    std::vector<std::uint32_t> middles(3 * triangles);
    {
        std::uint64_t last = 0;
        for (const EdgeOfCorner& edge : sortedEdges(mesh)) {
            if (fine.mesh.points.size() == points || edge.key != last) {
                const auto low = static_cast<std::uint32_t>(edge.key >> 32);
                const auto high = static_cast<std::uint32_t>(edge.key & 0xffffffffU);
                fine.mesh.points.push_back((mesh.points[low] + mesh.points[high]) / 2.0);
                Vec3f normal = coarse.normals[low] + coarse.normals[high];
                const float length = normal.length();
                fine.normals.push_back(length > 0 ? normal / length : coarse.normals[low]);
                last = edge.key;
            }
            middles[edge.corner] = static_cast<std::uint32_t>(fine.mesh.points.size() - 1);
        }
    }
    forSurface(fine.mesh.points.size() - points, "cut triangles", surface.field, progress,
               [&](std::size_t i, DensityProbe& probe) {
                   bringOnto(surface, probe, fine.mesh.points[points + i],
                             fine.normals[points + i]);
               });
    fine.mesh.triangles.reserve(4 * triangles);
    for (std::size_t i = 0; i < triangles; ++i) {
        const openvdb::Vec3I& t = mesh.triangles[i];
        const openvdb::Vec3I m(middles[3 * i], middles[3 * i + 1], middles[3 * i + 2]);
        fine.mesh.triangles.emplace_back(t[0], m[0], m[2]);
        fine.mesh.triangles.emplace_back(t[1], m[1], m[0]);
        fine.mesh.triangles.emplace_back(t[2], m[2], m[1]);
        fine.mesh.triangles.push_back(m);
    }
    return fine;
}

double measureDeviation(const Mesh& mesh, const IsoSurface& surface, Progress& progress) {
    std::vector<double> found(mesh.triangles.size(), 0);
    forSurface(found.size(), "measure deviation", surface.field, progress,
               [&](std::size_t i, DensityProbe& probe) {
                   const TriangleCorners c = cornersOf(mesh, i);
                   const Vec3d place = (c[0] + c[1] + c[2]) / 3.0;
                   const DensityAt at = probe.evaluate(surface.transform.worldToIndex(place));
                   const double slope = surface.transform.baseMap()->applyIJT(at.gradient).length();
                   // The corners are on the surface, so it is no farther than they are.
                   for (const Vec3d& corner : c) {
                       found[i] = std::max(found[i], (corner - place).length());
                   }
                   if (slope > 0) {
                       found[i] = std::min(found[i], std::abs(at.value - surface.iso) / slope);
                   }
               });
    double largest = 0;
    for (const double deviation : found) largest = std::max(largest, deviation);
    return largest;
}

}  // namespace bandvox

#include "mesh/collapse_points.h"

#include "mesh/collapse_region.h"
#include "source/mesh_bounds.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// Regions are shifted by these parts of their side: what is at a border once is inside later.
constexpr std::array kShifts{0.0, 0.5, 0.25};

/// The cubes of a mesh, and which triangles lie in each.
class RegionTriangles {
  public:
    RegionTriangles(const CollapsingMesh& mesh, const openvdb::BBoxd& box, double side);

    std::size_t count() const { return mStart.size() - 1; }
    std::span<const std::uint32_t> of(std::size_t region) const {
        return {&mTriangles[mStart[region]], mStart[region + 1] - mStart[region]};
    }

  private:
    std::vector<std::size_t> mStart;
    std::vector<std::uint32_t> mTriangles;
};

RegionTriangles::RegionTriangles(const CollapsingMesh& mesh, const openvdb::BBoxd& box,
                                 double side) {
    const Mesh& triangles = mesh.surface.mesh;
    const auto regionOf = [&](const Vec3d& place) {
        const Vec3d scaled = (place - box.min()) / side;
        return openvdb::Coord::floor(scaled);
    };
    // Triangles of one region side by side; those of several regions are left out.
    std::vector<std::pair<openvdb::Coord, std::uint32_t>> keys;
    keys.reserve(triangles.triangles.size());
    for (std::uint32_t t = 0; t < triangles.triangles.size(); ++t) {
        if (mesh.error[t] < 0) continue;
        const openvdb::Vec3I& corners = triangles.triangles[t];
        const openvdb::Coord region = regionOf(triangles.points[corners[0]]);
        if (region != regionOf(triangles.points[corners[1]]) ||
            region != regionOf(triangles.points[corners[2]])) {
            continue;
        }
        keys.emplace_back(region, t);
    }
    std::sort(keys.begin(), keys.end());
    mTriangles.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i == 0 || keys[i].first != keys[i - 1].first) mStart.push_back(i);
        mTriangles.push_back(keys[i].second);
    }
    mStart.push_back(keys.size());
}

// Leaves out the triangles that are gone and the points that none uses.
void compact(CollapsingMesh& mesh) {
    constexpr std::uint32_t kNone = ~0U;
    SurfaceMesh& surface = mesh.surface;
    std::vector<std::uint32_t>& number = mesh.local;
    std::fill(number.begin(), number.end(), kNone);
    std::size_t triangles = 0;
    for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
        if (mesh.error[t] < 0) continue;
        const openvdb::Vec3I corners = surface.mesh.triangles[t];
        for (int k = 0; k < 3; ++k) number[corners[k]] = 0;
        surface.mesh.triangles[triangles++] = corners;
    }
    surface.mesh.triangles.resize(triangles);
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] == kNone) continue;
        surface.mesh.points[points] = surface.mesh.points[i];
        surface.normals[points] = surface.normals[i];
        number[i] = points++;
    }
    surface.mesh.points.resize(points);
    surface.normals.resize(points);
    for (openvdb::Vec3I& triangle : surface.mesh.triangles) {
        for (int k = 0; k < 3; ++k) triangle[k] = number[triangle[k]];
    }
}

}  // namespace

std::size_t collapsePoints(SurfaceMesh& surface, const CollapseOptions& options,
                           Progress& progress) {
    const std::size_t points = surface.mesh.points.size();
    CollapsingMesh mesh{surface, std::vector<float>(surface.mesh.triangles.size(), 0.0F),
                        std::vector<std::uint32_t>(points), std::vector<std::uint32_t>(points)};
    const openvdb::BBoxd box = boundsOf(surface.mesh);
    for (const double shift : kShifts) {
        std::fill(mesh.degree.begin(), mesh.degree.end(), 0);
        for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
            if (mesh.error[t] < 0) continue;
            for (int k = 0; k < 3; ++k) ++mesh.degree[surface.mesh.triangles[t][k]];
        }
        openvdb::BBoxd shifted = box;
        shifted.min() -= Vec3d(shift * options.regionSide);
        const RegionTriangles regions(mesh, shifted, options.regionSide);
        const auto count = static_cast<std::int64_t>(regions.count());
        const ProgressStage stage(progress, "leave points out", count);
        parallelFor(count, [&](std::int64_t i) {
            progress.throwIfInterrupted();
            CollapseRegion(mesh, regions.of(static_cast<std::size_t>(i)), options.tolerance)
                .collapse();
            progress.advance();
        });
    }
    compact(mesh);
    return points - surface.mesh.points.size();
}

}  // namespace bandvox

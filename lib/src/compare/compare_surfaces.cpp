#include "compare/farthest_point.h"
#include "core/words.h"
#include "mesh/triangle_tree.h"
#include "source/mesh_bounds.h"

#include <bandvox/compare/compare_surfaces.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {

namespace {

using openvdb::Vec3d;

constexpr std::size_t kPlacesPerTask = 4096;
constexpr double kToleranceOfDiagonal = 1e-3;

double areaOf(const TriangleCorners& c) {
    return (c[1] - c[0]).cross(c[2] - c[0]).length() / 2;
}

// The normal at a point of a triangle; none if the triangle has no area.
Vec3d normalAt(const ComparedSurface& surface, std::uint32_t triangle, const Vec3d& weights) {
    Vec3d normal(0.0);
    if (surface.normals.empty()) {
        const TriangleCorners c = cornersOf(surface.mesh, triangle);
        normal = (c[1] - c[0]).cross(c[2] - c[0]);
    } else {
        const openvdb::Vec3I& t = surface.mesh.triangles[triangle];
        for (int k = 0; k < 3; ++k) normal += weights[k] * Vec3d(surface.normals[t[k]]);
    }
    const double length = normal.length();
    return length > 0 ? normal / length : normal;
}

// What is found at the middle of a triangle.
struct AngleAt {
    double angle;  // degrees
    double area;   // of the triangle; 0 where there is no normal
};

// One of the two directions.
struct Direction {
    std::vector<PlaceDistance> corners, middles;
    std::vector<AngleAt> angles;
};

// Calls body(i, hint) for i < count; `hint` is kept by the body from one to the next.
template <typename Body>
void forPlaces(std::size_t count, const char* what, Progress& progress, const Body& body) {
    const std::size_t tasks = (count + kPlacesPerTask - 1) / kPlacesPerTask;
    const ProgressStage stage(progress, what, static_cast<std::int64_t>(tasks));
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        std::uint32_t hint = 0;
        const std::size_t begin = static_cast<std::size_t>(task) * kPlacesPerTask;
        for (std::size_t i = begin; i < std::min(begin + kPlacesPerTask, count); ++i) {
            body(i, hint);
        }
        progress.advance();
    });
}

Direction look(const ComparedSurface& from, const ComparedSurface& to, const TriangleTree& tree,
               Progress& progress) {
    Direction direction;
    direction.corners.resize(from.mesh.points.size());
    forPlaces(from.mesh.points.size(), "distances of points", progress,
              [&](std::size_t i, std::uint32_t& hint) {
                  direction.corners[i] = placeDistance(tree, from.mesh.points[i], hint);
                  hint = direction.corners[i].triangle;
              });
    const std::size_t triangles = from.mesh.triangles.size();
    direction.middles.resize(triangles);
    direction.angles.resize(triangles);
    forPlaces(triangles, "distances of triangles", progress,
              [&](std::size_t i, std::uint32_t& hint) {
                  const TriangleCorners corners = cornersOf(from.mesh, i);
                  const Vec3d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                  const NearestOnMesh nearest = tree.nearest(middle, hint);
                  hint = nearest.triangle;
                  direction.middles[i] = {middle, std::sqrt(nearest.square), nearest.triangle};
                  const Vec3d a = normalAt(from, static_cast<std::uint32_t>(i), Vec3d(1.0 / 3));
                  const Vec3d b = normalAt(to, nearest.triangle, nearest.weights);
                  const bool exist = a.lengthSqr() > 0 && b.lengthSqr() > 0;
                  const double angle = std::atan2(a.cross(b).length(), a.dot(b));
                  direction.angles[i] = {exist ? angle * 180 / openvdb::math::pi<double>() : 0,
                                         exist ? areaOf(corners) : 0};
              });
    return direction;
}

// Means over triangles: ∫ g = area (9 g(middle) + Σ g(corner)) / 12, exact for degree 2.
void addMeans(const Mesh& mesh, const Direction& direction, OneSidedDistance& result) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const openvdb::Vec3I& t = mesh.triangles[i];
        const double middle = direction.middles[i].distance;
        double once = 9 * middle, square = 9 * middle * middle;
        for (int k = 0; k < 3; ++k) {
            const double corner = direction.corners[t[k]].distance;
            once += corner;
            square += corner * corner;
        }
        const double area = areaOf(cornersOf(mesh, i));
        result.area += area;
        sum += area * once / 12;
        squares += area * square / 12;
    }
    if (!(result.area > 0)) return;
    result.mean = sum / result.area;
    result.rms = std::sqrt(squares / result.area);
}

OneSidedDistance measure(const ComparedSurface& from, const TriangleTree& to,
                         const Direction& direction, const FarthestSearch& search,
                         Progress& progress) {
    OneSidedDistance result;
    addMeans(from.mesh, direction, result);
    const ProgressStage stage(progress, "farthest point", 0);
    const FarthestPoint farthest =
        findFarthest(from.mesh, to, direction.corners, direction.middles, search, progress);
    result.maximum = farthest.distance;
    result.atMost = farthest.atMost;
    result.at = farthest.at.place;
    result.nearest = to.nearest(farthest.at.place, farthest.at.triangle).point;
    return result;
}

NormalAngles anglesOf(const Direction& a, const Direction& b) {
    NormalAngles result;
    double areas[2] = {0, 0}, sums[2] = {0, 0};
    std::vector<std::pair<double, double>> sorted;
    sorted.reserve(a.angles.size() + b.angles.size());
    for (int side = 0; side < 2; ++side) {
        for (const AngleAt& at : (side == 0 ? a : b).angles) {
            if (!(at.area > 0)) continue;
            areas[side] += at.area;
            sums[side] += at.area * at.angle;
            sorted.emplace_back(at.angle, at.area);
        }
    }
    if (sorted.empty()) return result;
    const double area = areas[0] + areas[1];
    result.mean = (sums[0] + sums[1]) / area;
    std::sort(sorted.begin(), sorted.end());
    result.maximum = sorted.back().first;
    result.percent95 = result.maximum;
    double below = 0;
    for (const auto& entry : sorted) {
        below += entry.second;
        if (below < 0.95 * area) continue;
        result.percent95 = entry.first;
        break;
    }
    return result;
}

void requireSurface(const ComparedSurface& surface) {
    const Mesh& mesh = surface.mesh;
    if (mesh.triangles.empty()) {
        throw Error(ErrorKind::Input,
                    "a surface that should be compared has no triangles; expected one at least");
    }
    const std::size_t points = mesh.points.size();
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const std::size_t largest = std::max({t[0], t[1], t[2]});
        if (largest < points) continue;
        throw Error(ErrorKind::Input, "a triangle refers to point " + std::to_string(largest) +
                                          " of a mesh with " + counted(points, "point", "points"));
    }
    for (const Vec3d& p : mesh.points) {
        if (p.isFinite()) continue;
        throw Error(ErrorKind::Input, "a mesh has a coordinate that is not finite");
    }
    if (!surface.normals.empty() && surface.normals.size() != points) {
        throw Error(ErrorKind::Usage, "a mesh has " + counted(points, "point", "points") + " and " +
                                          counted(surface.normals.size(), "normal", "normals") +
                                          "; expected as many, or none");
    }
    if (!(surface.deviation >= 0 && std::isfinite(surface.deviation))) {
        throw Error(ErrorKind::Usage, "the deviation of a mesh is " + inShort(surface.deviation) +
                                          "; it must be 0 or more");
    }
}

}  // namespace

SurfaceDifference compareSurfaces(const ComparedSurface& a, const ComparedSurface& b,
                                  const CompareSurfacesOptions& options, Progress& progress) {
    requireSurface(a);
    requireSurface(b);
    if (!(options.tolerance >= 0 && std::isfinite(options.tolerance))) {
        throw Error(ErrorKind::Usage, "the tolerance of comparing surfaces is " +
                                          inShort(options.tolerance) + "; it must be 0 or more");
    }
    FarthestSearch search{options.tolerance, options.mostPieces};
    if (search.tolerance == 0) {
        openvdb::BBoxd box = boundsOf(a.mesh);
        box.expand(boundsOf(b.mesh));
        search.tolerance = kToleranceOfDiagonal * box.extents().length();
    }

    SurfaceDifference result;
    const TriangleTree treeOfA(a.mesh), treeOfB(b.mesh);
    const Direction fromA = look(a, b, treeOfB, progress);
    const Direction fromB = look(b, a, treeOfA, progress);
    result.angles = anglesOf(fromA, fromB);
    result.fromA = measure(a, treeOfB, fromA, search, progress);
    result.fromB = measure(b, treeOfA, fromB, search, progress);
    result.hausdorff = std::max(result.fromA.maximum, result.fromB.maximum);
    result.hausdorffAtMost =
        std::max(result.fromA.atMost, result.fromB.atMost) + (a.deviation + b.deviation);
    const double area = result.fromA.area + result.fromB.area;
    if (area > 0) {
        result.meanDistance =
            (result.fromA.mean * result.fromA.area + result.fromB.mean * result.fromB.area) / area;
    }
    return result;
}

}  // namespace bandvox

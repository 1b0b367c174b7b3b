#include "source/stitch_cracks.h"

#include "source/box_tree.h"
#include "source/directed_edges.h"
#include "source/mesh_bounds.h"
#include "source/no_index.h"
#include "source/weld_points.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// Cracks are narrow beside the edges along them: no wider than this part of most.
constexpr double kWidestCrack = 0.1;

// What is joined may bring more to lie on an edge.
constexpr int kMostRounds = 4;

PointLists edgesOf(const Mesh& mesh) {
    return listEdges(DirectedEdges(mesh), mesh.points.size());
}

/// Directed edges, by their numbers, that only one triangle has.
std::vector<std::uint32_t> boundaryEdges(const Mesh& mesh, const PointLists& lists) {
    const DirectedEdges edges(mesh);
    std::vector<std::vector<std::uint32_t>> parts(indexBlocks(mesh.points.size()));
    forEachGroupInBlocks(edges, lists,
                         [&](std::size_t block, std::span<const std::uint32_t> group) {
                             if (group.size() == 1) parts[block].push_back(group.front());
                         });
    std::vector<std::uint32_t> boundary;
    for (const std::vector<std::uint32_t>& part : parts) {
        boundary.insert(boundary.end(), part.begin(), part.end());
    }
    std::sort(boundary.begin(), boundary.end());
    return boundary;
}

/// The length that half of the boundary's edges exceed.
double usualLength(const Mesh& mesh, const std::vector<std::uint32_t>& boundary) {
    const DirectedEdges edges(mesh);
    std::vector<double> lengths;
    lengths.reserve(boundary.size());
    for (const std::uint32_t e : boundary) {
        lengths.push_back((mesh.points[edges.to(e)] - mesh.points[edges.from(e)]).length());
    }
    const auto middle = lengths.begin() + std::ssize(lengths) / 2;
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
}

std::vector<std::uint32_t> pointsOf(const Mesh& mesh, const std::vector<std::uint32_t>& boundary) {
    const DirectedEdges edges(mesh);
    std::vector<std::uint32_t> points;
    for (const std::uint32_t e : boundary) {
        points.push_back(edges.from(e));
        points.push_back(edges.to(e));
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

/// Makes boundary points that are near each other one. Returns how many fell together.
std::size_t joinPoints(Mesh& mesh, const std::vector<std::uint32_t>& points, double tolerance) {
    std::vector<Vec3d> places;
    places.reserve(points.size());
    for (const std::uint32_t p : points) places.push_back(mesh.points[p]);
    const std::vector<std::uint32_t> joined = weld(places, tolerance);
    const std::size_t fewer = points.size() - places.size();
    if (fewer == 0) return 0;
    std::vector<std::uint32_t> first(places.size(), kNoIndex);  // of those that became one
    std::vector<std::uint32_t> newIndex(mesh.points.size(), kNoIndex);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (first[joined[i]] == kNoIndex) first[joined[i]] = points[i];
        newIndex[points[i]] = first[joined[i]];
    }
    for (openvdb::Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            if (newIndex[t[k]] != kNoIndex) t[k] = newIndex[t[k]];
        }
    }
    dropCollapsed(mesh);
    return fewer;
}

/// A point on an edge, and how far along it lies, 0 to 1.
struct OnEdge {
    std::uint32_t edge;
    double along;
    std::uint32_t point;
};

/// A part of an edge, the boundary's number i, from and to these lengths along it.
struct EdgePart {
    std::uint32_t i;
    double begin, end;
};

/// Edges in parts, so that the boxes around slanting ones stay slim.
std::vector<EdgePart> cutEdges(const Mesh& mesh, const std::vector<std::uint32_t>& boundary) {
    constexpr double kPartsOfMesh = 64;
    const DirectedEdges edges(mesh);
    const double longest = boundsOf(mesh).extents().length() / kPartsOfMesh;
    std::vector<EdgePart> parts;
    for (std::uint32_t i = 0; i < boundary.size(); ++i) {
        const std::uint32_t e = boundary[i];
        const double length = (mesh.points[edges.to(e)] - mesh.points[edges.from(e)]).length();
        const int count = 1 + static_cast<int>(length / longest);
        for (int k = 0; k < count; ++k) {
            parts.push_back({i, length * k / count, length * (k + 1) / count});
        }
    }
    return parts;
}

/// Boundary points that lie on boundary edges, by edge and from its start to its end.
std::vector<OnEdge> findOnEdges(const Mesh& mesh, const std::vector<std::uint32_t>& boundary,
                                double tolerance, const Progress& progress) {
    const DirectedEdges edges(mesh);
    const std::vector<EdgePart> parts = cutEdges(mesh, boundary);
    std::vector<openvdb::BBoxd> boxes;
    boxes.reserve(parts.size());
    for (const EdgePart& part : parts) {
        const Vec3d& from = mesh.points[edges.from(boundary[part.i])];
        const Vec3d along = (mesh.points[edges.to(boundary[part.i])] - from).unit();
        openvdb::BBoxd box;
        box.expand(from + part.begin * along);
        box.expand(from + part.end * along);
        box.expand(2 * tolerance);
        boxes.push_back(box);
    }
    const BoxTree tree(std::move(boxes));
    std::vector<OnEdge> found;
    for (const std::uint32_t p : pointsOf(mesh, boundary)) {
        progress.throwIfInterrupted();
        const Vec3d& place = mesh.points[p];
        tree.visitAround(place, [&](std::uint32_t i) {
            const std::uint32_t e = boundary[parts[i].i];
            if (edges.from(e) == p || edges.to(e) == p) return;
            const Vec3d& from = mesh.points[edges.from(e)];
            const Vec3d edge = mesh.points[edges.to(e)] - from;
            const double length = edge.length();
            const double along = (place - from).dot(edge) / length;
            // One of its parts is enough, and what is nearer to an end has been joined with it, or
            // is its own neighbour.
            if (!(along >= parts[i].begin && along < parts[i].end)) return;
            if (!(along > tolerance && along < length - tolerance)) return;
            if ((place - from - along / length * edge).length() > tolerance) return;
            found.push_back({e, along / length, p});
        });
    }
    std::sort(found.begin(), found.end(), [](const OnEdge& a, const OnEdge& b) {
        return std::tuple(a.edge, a.along, a.point) < std::tuple(b.edge, b.along, b.point);
    });
    return found;
}

/// Splits edges where points lie on them. Returns how many edges that were.
std::size_t splitEdges(Mesh& mesh, const std::vector<OnEdge>& onEdges) {
    // Of a triangle's edges one at a time: the next round finds the others.
    std::size_t split = 0;
    std::uint32_t last = kNoIndex;
    for (std::size_t begin = 0; begin < onEdges.size();) {
        const std::uint32_t edge = onEdges[begin].edge;
        std::size_t end = begin;
        while (end < onEdges.size() && onEdges[end].edge == edge) ++end;
        if (std::exchange(last, edge / 3) != edge / 3) {
            const openvdb::Vec3I whole = mesh.triangles[edge / 3];
            const std::uint32_t to = whole[(edge + 1) % 3], apex = whole[(edge + 2) % 3];
            std::uint32_t from = whole[edge % 3];
            bool isFirst = true;
            const auto add = [&](std::uint32_t next) {
                const openvdb::Vec3I part(from, next, apex);
                if (std::exchange(isFirst, false)) {
                    mesh.triangles[edge / 3] = part;
                } else {
                    mesh.triangles.push_back(part);
                }
                from = next;
            };
            for (std::size_t i = begin; i < end; ++i) {
                if (onEdges[i].point != apex) add(onEdges[i].point);
            }
            add(to);
            ++split;
        }
        begin = end;
    }
    return split;
}

}  // namespace

StitchedCracks stitchCracks(Mesh& mesh, double tolerance, Progress& progress) {
    StitchedCracks stitched;
    stitched.edges = edgesOf(mesh);
    for (int round = 0; round < kMostRounds; ++round) {
        std::vector<std::uint32_t> boundary = boundaryEdges(mesh, stitched.edges);
        if (boundary.empty()) break;
        if (round == 0) {
            tolerance = std::min(tolerance, kWidestCrack * usualLength(mesh, boundary));
        }
        const std::size_t joined = joinPoints(mesh, pointsOf(mesh, boundary), tolerance);
        if (joined > 0) {
            stitched.edges = edgesOf(mesh);
            boundary = boundaryEdges(mesh, stitched.edges);
        }
        const std::size_t split =
            splitEdges(mesh, findOnEdges(mesh, boundary, tolerance, progress));
        if (split > 0) stitched.edges = edgesOf(mesh);
        stitched.pointsJoined += joined;
        stitched.edgesSplit += split;
        if (split == 0) break;
    }
    const std::size_t points = mesh.points.size();
    removeUnusedPoints(mesh);
    if (mesh.points.size() < points) stitched.edges = edgesOf(mesh);
    return stitched;
}

}  // namespace bandvox

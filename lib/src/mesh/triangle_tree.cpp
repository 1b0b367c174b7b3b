#include "mesh/triangle_tree.h"

#include <bandvox/core/memory.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace bandvox {

namespace {

constexpr std::uint32_t kTrianglesInLeaf = 4;
// Halving 2^32 triangles ends well before.
constexpr std::size_t kDeepest = 64;

double squareTo(const openvdb::BBoxd& box, const openvdb::Vec3d& place) {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double outside =
            std::max({box.min()[axis] - place[axis], place[axis] - box.max()[axis], 0.0});
        square += outside * outside;
    }
    return square;
}

NearestOnTriangle nearestOnEdge(const openvdb::Vec3d& place, const TriangleCorners& corners,
                                int edge) {
    const int next = (edge + 1) % 3;
    const openvdb::Vec3d along = corners[next] - corners[edge];
    const double square = along.lengthSqr();
    const double t =
        square > 0 ? std::clamp((place - corners[edge]).dot(along) / square, 0.0, 1.0) : 0.0;
    NearestOnTriangle nearest;
    nearest.point = corners[edge] + t * along;
    nearest.weights[edge] = 1 - t;
    nearest.weights[next] = t;
    nearest.square = (place - nearest.point).lengthSqr();
    return nearest;
}

}  // namespace

NearestOnTriangle nearestOnTriangle(const openvdb::Vec3d& place, const TriangleCorners& corners) {
    // It lies in the plane if that is within all three edges, else on an edge.
    const openvdb::Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double square = normal.lengthSqr();
    bool isWithin = square > 0;
    openvdb::Vec3d weights(0.0);
    for (int k = 0; k < 3 && isWithin; ++k) {
        const openvdb::Vec3d& from = corners[(k + 1) % 3];
        weights[k] = normal.dot((corners[(k + 2) % 3] - from).cross(place - from)) / square;
        isWithin = weights[k] >= 0;
    }
    if (isWithin) {
        NearestOnTriangle nearest;
        nearest.weights = weights;
        const double height = normal.dot(place - corners[0]);
        nearest.point = place - normal * (height / square);
        nearest.square = height * height / square;
        return nearest;
    }
    NearestOnTriangle nearest = nearestOnEdge(place, corners, 0);
    for (int edge = 1; edge < 3; ++edge) {
        const NearestOnTriangle other = nearestOnEdge(place, corners, edge);
        if (other.square < nearest.square) nearest = other;
    }
    return nearest;
}

TriangleTree::TriangleTree(const Mesh& mesh) : mMesh(mesh), mOrder(mesh.triangles.size()) {
    // Leaves are half full at least, and there are as many nodes above them.
    const double nodes = 4.0 * static_cast<double>(mOrder.size()) / kTrianglesInLeaf + 1;
    requireMemory(nodes * sizeof(Node), "the search for nearest points");
    mNodes.reserve(static_cast<std::size_t>(nodes));
    std::iota(mOrder.begin(), mOrder.end(), 0U);
    build(0, static_cast<std::uint32_t>(mOrder.size()));
}

void TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t node = mNodes.size();
    mNodes.push_back({{}, begin, end, 0});
    openvdb::BBoxd box;
    for (std::uint32_t i = begin; i < end; ++i) {
        for (const openvdb::Vec3d& corner : cornersOf(mMesh, mOrder[i])) box.expand(corner);
    }
    mNodes[node].box = box;
    if (end - begin <= kTrianglesInLeaf) return;

    // Halve the triangles by their middles along the longest side; this ends however they lie.
    const auto axis = static_cast<int>(box.maxExtent());
    const auto middleOf = [&](std::uint32_t triangle) {
        const openvdb::Vec3I& t = mMesh.triangles[triangle];
        return mMesh.points[t[0]][axis] + mMesh.points[t[1]][axis] + mMesh.points[t[2]][axis];
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(mOrder.begin() + begin, mOrder.begin() + middle, mOrder.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(middleOf(a), a) < std::pair(middleOf(b), b);
                     });
    build(begin, middle);
    mNodes[node].right = static_cast<std::uint32_t>(mNodes.size());
    build(middle, end);
}

void TriangleTree::look(const openvdb::Vec3d& place, std::uint32_t triangle,
                        NearestOnMesh& found) const {
    const NearestOnTriangle here = nearestOnTriangle(place, cornersOf(mMesh, triangle));
    // Of equals the first, so that the hint does not matter.
    if (here.square > found.square) return;
    if (here.square == found.square && triangle >= found.triangle) return;
    static_cast<NearestOnTriangle&>(found) = here;
    found.triangle = triangle;
}

NearestOnMesh TriangleTree::nearest(const openvdb::Vec3d& place, std::uint32_t hint) const {
    NearestOnMesh found;
    look(place, std::min(hint, static_cast<std::uint32_t>(mOrder.size() - 1)), found);
    search(place, found);
    return found;
}

std::optional<NearestOnMesh> TriangleTree::nearestWithin(const openvdb::Vec3d& place,
                                                         double distance,
                                                         std::optional<std::uint32_t> hint) const {
    NearestOnMesh found;
    found.square = distance * distance;
    if (hint) look(place, *hint, found);
    search(place, found);
    if (found.triangle == NearestOnMesh().triangle) return std::nullopt;
    return found;
}

void TriangleTree::search(const openvdb::Vec3d& place, NearestOnMesh& found) const {
    struct Pending {
        std::uint32_t node;
        double square;
    };
    std::array<Pending, kDeepest> pending;
    std::size_t count = 0;
    pending[count++] = {0, squareTo(mNodes[0].box, place)};
    while (count > 0) {
        const Pending top = pending[--count];
        if (top.square > found.square) continue;
        const Node& node = mNodes[top.node];
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) look(place, mOrder[i], found);
            continue;
        }
        Pending near{top.node + 1, squareTo(mNodes[top.node + 1].box, place)};
        Pending far{node.right, squareTo(mNodes[node.right].box, place)};
        if (far.square < near.square) std::swap(near, far);
        pending[count++] = far;
        pending[count++] = near;
    }
}

}  // namespace bandvox

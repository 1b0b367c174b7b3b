#include "source/winding_tree.h"

#include "source/directed_edges.h"
#include "source/triangle_distance.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <utility>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;
using openvdb::Vec3I;

constexpr std::uint32_t kTreeLeaf = 4;  // triangles of a leaf at most

// The gradient's bound takes it together from so many radii beyond its ball.
constexpr double kFarForBound = 1;

// Trees of this many triangles are built by a task of their own.
constexpr std::uint32_t kTaskTriangles = 8192;

Vec3d middleOf(const std::array<Vec3d, 3>& corner) {
    return (corner[0] + corner[1] + corner[2]) / 3.0;
}

double squareDistance(const BBoxd& box, const Vec3d& point) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double away =
            std::max({box.min()[axis] - point[axis], 0.0, point[axis] - box.max()[axis]});
        sum += away * away;
    }
    return sum;
}

// By the triangle's box and its plane.
bool mayMeetTriangle(const BBoxd& box, const std::array<Vec3d, 3>& corner) {
    for (int axis = 0; axis < 3; ++axis) {
        const double a = corner[0][axis], b = corner[1][axis], c = corner[2][axis];
        if (std::min({a, b, c}) > box.max()[axis] || std::max({a, b, c}) < box.min()[axis]) {
            return false;
        }
    }
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const Vec3d half = 0.5 * box.extents();
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) reach += std::abs(normal[axis]) * half[axis];
    constexpr double kRounding = 1e-9;
    return std::abs(normal.dot(box.getCenter() - corner[0])) <=
           reach + kRounding * normal.length() * half.length();
}

}  // namespace

WindingTree::WindingTree(Mesh mesh)
    : mPoints(std::move(mesh.points)), mTriangles(std::move(mesh.triangles)) {
    const double nodes = std::max(1.0, 2.0 * static_cast<double>(mTriangles.size()) / 3);
    requireMemory(nodes * (2 * sizeof(Node) + sizeof(mCoefficients[0])),
                  "the tree of the winding number");
    if (mTriangles.empty()) return;
    sortTriangles();
    mOpenEdges = findOpenEdges();

    // Build the subtrees at a depth at which they are small, then what is above them.
    const auto count = static_cast<std::uint32_t>(mTriangles.size());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges{{0, count}};
    while ((ranges[0].second - ranges[0].first) > kTaskTriangles) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> halves;
        for (const auto& [begin, end] : ranges) {
            const std::uint32_t middle = begin + (end - begin) / 2;
            halves.push_back({begin, middle});
            halves.push_back({middle, end});
        }
        ranges = std::move(halves);
    }
    std::vector<std::vector<Node>> trees(ranges.size());
    parallelFor(static_cast<std::int64_t>(ranges.size()), [&](std::int64_t i) {
        build(ranges[i].first, ranges[i].second, mOpenEdges, trees[i]);
    });
    while (trees.size() > 1) {
        std::vector<std::vector<Node>> joined;
        for (std::size_t i = 0; i + 1 < trees.size(); i += 2) {
            std::vector<Node>& left = trees[i];
            std::vector<Node>& right = trees[i + 1];
            Node top;
            fillFromChildren(left[0], right[0], top);
            top.right = static_cast<std::uint32_t>(1 + left.size());
            std::vector<Node>& tree = joined.emplace_back(1, top);
            tree.reserve(1 + left.size() + right.size());
            const auto append = [&tree](const std::vector<Node>& part) {
                const auto shift = static_cast<std::uint32_t>(tree.size());
                for (Node node : part) {
                    if (node.right != 0) node.right += shift;
                    tree.push_back(node);
                }
            };
            append(left);
            append(right);
            left = {};
            right = {};
        }
        trees = std::move(joined);
    }
    mNodes = std::move(trees[0]);
    mCoefficients.resize(mNodes.size());
    for (std::size_t i = 0; i < mNodes.size(); ++i) {
        const double unit = mNodes[i].radius;
        if (unit > 0) mCoefficients[i] = mNodes[i].moments.coefficients(unit);
    }
}

// Orders the triangles so that those of each node, which halves them, are a range.
void WindingTree::sortTriangles() {
    std::vector<Vec3d> middle(mTriangles.size());
    for (std::uint32_t t = 0; t < middle.size(); ++t) middle[t] = middleOf(corners(t));
    std::vector<std::uint32_t> order(mTriangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> level{
        {0, static_cast<std::uint32_t>(order.size())}};
    // The ranges of one level are independent of each other; the last one is the longest.
    while (level.back().second - level.back().first > kTreeLeaf) {
        const std::int64_t batches = std::min<std::int64_t>(64, std::ssize(level));
        parallelFor(batches, [&](std::int64_t batch) {
            const std::size_t first = level.size() * batch / batches;
            const std::size_t last = level.size() * (batch + 1) / batches;
            for (std::size_t i = first; i < last; ++i) {
                const auto [begin, end] = level[i];
                BBoxd box;
                for (std::uint32_t k = begin; k < end; ++k) box.expand(middle[order[k]]);
                const auto axis = static_cast<int>(box.maxExtent());
                std::nth_element(order.begin() + begin, order.begin() + begin + (end - begin) / 2,
                                 order.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
                                     return std::pair(middle[a][axis], a) <
                                            std::pair(middle[b][axis], b);
                                 });
            }
        });
        std::vector<std::pair<std::uint32_t, std::uint32_t>> halves;
        halves.reserve(2 * level.size());
        for (const auto& [begin, end] : level) {
            const std::uint32_t half = begin + (end - begin) / 2;
            halves.push_back({begin, half});
            halves.push_back({half, end});
        }
        level = std::move(halves);
    }
    std::vector<Vec3I> sorted(mTriangles.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = mTriangles[order[i]];
    mTriangles = std::move(sorted);
}

// An edge is open as often as it has one direction more often than the other; one of its triangles
// stands for all of that.
std::vector<std::uint8_t> WindingTree::findOpenEdges() const {
    Mesh mesh;
    mesh.triangles = mTriangles;
    const DirectedEdges edges(mesh);
    const std::vector<std::uint32_t> order = groupEdges(edges, mPoints.size());
    std::vector<std::uint8_t> open(mTriangles.size(), 0);
    forEachGroup(edges, order, [&](std::size_t begin, std::size_t end) {
        int net = 0;
        for (std::size_t i = begin; i < end; ++i) net += edges.rises(order[i]) ? 1 : -1;
        for (std::size_t i = begin; i < begin + std::abs(net); ++i) {
            open[order[i] / 3] |= static_cast<std::uint8_t>(1u << order[i] % 3);
        }
    });
    return open;
}

void WindingTree::build(std::uint32_t begin, std::uint32_t end,
                        const std::vector<std::uint8_t>& open, std::vector<Node>& nodes) const {
    const std::size_t index = nodes.size();
    nodes.emplace_back();
    if (end - begin <= kTreeLeaf) {
        nodes[index].begin = begin;
        nodes[index].end = end;
        fillLeaf(open, nodes[index]);
        return;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    build(begin, middle, open, nodes);
    const std::size_t right = nodes.size();
    build(middle, end, open, nodes);
    fillFromChildren(nodes[index + 1], nodes[right], nodes[index]);
    nodes[index].right = static_cast<std::uint32_t>(right);
}

void WindingTree::fillLeaf(const std::vector<std::uint8_t>& open, Node& node) const {
    Vec3d weighted(0.0), plain(0.0);
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const std::array<Vec3d, 3> corner = corners(t);
        const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).length();
        node.area += area;
        weighted += area * middleOf(corner);
        plain += middleOf(corner);
        for (int k = 0; k < 3; ++k) {
            if ((open[t] >> k & 1) != 0) {
                node.openLength += (corner[(k + 1) % 3] - corner[k]).length();
            }
        }
    }
    node.center = node.area > 0 ? weighted / node.area : plain / (node.end - node.begin);
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const std::array<Vec3d, 3> corner = corners(t);
        for (const Vec3d& c : corner) {
            node.radius = std::max(node.radius, (c - node.center).length());
        }
        node.moments.add(WindingMoments::ofTriangle(corner, node.center), Vec3d(0.0));
    }
}

void WindingTree::fillFromChildren(const Node& left, const Node& right, Node& node) const {
    node.begin = left.begin;
    node.end = right.end;
    node.area = left.area + right.area;
    node.openLength = left.openLength + right.openLength;
    node.center = node.area > 0 ? (left.area * left.center + right.area * right.center) / node.area
                                : 0.5 * (left.center + right.center);
    for (const Node* child : {&left, &right}) {
        const Vec3d shift = child->center - node.center;
        node.moments.add(child->moments, shift);
        node.radius = std::max(node.radius, shift.length() + child->radius);
    }
    // Of a large node the children's balls say too much.
    constexpr std::uint32_t kFewTriangles = 4096;
    if (node.end - node.begin > kFewTriangles) return;
    double radius = 0;
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        for (const Vec3d& c : corners(t)) {
            radius = std::max(radius, (c - node.center).lengthSqr());
        }
    }
    node.radius = std::min(node.radius, std::sqrt(radius));
}

void WindingTree::collect(const WindingRegion& region, double farAway, WindingTerms& terms) const {
    const double size = mNodes.empty() ? 0 : mNodes[0].radius;
    terms.begin(region.center, region.radius > 0 ? region.radius : size > 0 ? size : 1);
    descend([&](std::uint32_t i) {
        const Node& node = mNodes[i];
        const double distance = (node.center - region.center).length() - region.radius;
        if (node.radius > 0 && distance > farAway * node.radius) {
            terms.addGroup(node.center, mCoefficients[i], node.radius);
            return false;
        }
        if (node.right == 0) {
            for (std::uint32_t t = node.begin; t < node.end; ++t) terms.addTriangle(corners(t));
        }
        return true;
    });
    terms.finish();
}

double WindingTree::gradientBound(const WindingRegion& region, double enough) const {
    constexpr double kPi = std::numbers::pi;
    GradientBounds bounds;
    descend([&](std::uint32_t i) {
        const Node& node = mNodes[i];
        if (bounds.byEdges > enough && bounds.byArea > enough) return false;
        const double distance =
            (node.center - region.center).length() - region.radius - node.radius;
        if (distance > kFarForBound * node.radius) {
            // By Biot and Savart, and by the field of a dipole.
            const double square = distance * distance;
            bounds.byEdges += node.openLength / (4 * kPi * square);
            bounds.byArea += node.area / (2 * kPi * square * distance);
            return false;
        }
        if (node.right == 0) boundByTriangles(node, region, bounds);
        return true;
    });
    return std::min(bounds.byEdges, bounds.byArea);
}

void WindingTree::boundByTriangles(const Node& node, const WindingRegion& region,
                                   GradientBounds& bounds) const {
    constexpr double kPi = std::numbers::pi;
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const std::array<Vec3d, 3> corner = corners(t);
        const Vec3d area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double distance =
            std::max(distanceToTriangle(region.center, corner) - region.radius, 0.0);
        bounds.byArea += area.length() / (2 * kPi * distance * distance * distance);
        for (int k = 0; k < 3; ++k) {
            if ((mOpenEdges[t] >> k & 1) == 0) continue;
            const Vec3d &a = corner[k], &b = corner[(k + 1) % 3];
            const double away =
                std::max(distanceToSegment(region.center, a, b) - region.radius, 0.0);
            bounds.byEdges += (b - a).length() / (4 * kPi * away * away);
        }
    }
}

bool WindingTree::mayMeet(const BBoxd& box) const {
    bool meets = false;
    descend([&](std::uint32_t i) {
        const Node& node = mNodes[i];
        if (meets || squareDistance(box, node.center) > node.radius * node.radius) return false;
        for (std::uint32_t t = node.begin; node.right == 0 && t < node.end; ++t) {
            meets = meets || mayMeetTriangle(box, corners(t));
        }
        return true;
    });
    return meets;
}

}  // namespace bandvox

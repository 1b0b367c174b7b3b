#include "source/cap_holes.h"

#include "source/no_index.h"
#include "source/triangulate_loop.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace bandvox {
namespace {

/// Takes the boundary of a piece apart into loops that pass through each point once.
///
/// As many edges arrive at a point as leave it, because that is so for the edges of each
/// triangle; so a walk along unused edges can end only where it began.
class LoopFinder {
  public:
    LoopFinder(const std::vector<BoundaryEdge>& edges, std::size_t pointCount)
        : mEdges(edges), mNext(pointCount, kNoIndex), mPosition(pointCount, kNoIndex) {}

    /// Calls visit(loop) for each loop of the edges [begin, end), which are of one piece.
    template <typename Visit>
    void findLoops(std::size_t begin, std::size_t end, const Visit& visit) {
        mEnd = end;
        for (std::size_t i = end; i-- > begin;)
            mNext[mEdges[i].from] = static_cast<std::uint32_t>(i);
        for (std::size_t i = begin; i < end; ++i) {
            while (hasUnused(mEdges[i].from)) walkFrom(mEdges[i].from, visit);
        }
    }

  private:
    /// True if an unused edge leaves the point.
    bool hasUnused(std::uint32_t point) const {
        return mNext[point] < mEnd && mEdges[mNext[point]].from == point;
    }

    template <typename Visit>
    void walkFrom(std::uint32_t start, const Visit& visit) {
        mPath.assign(1, start);
        mPosition[start] = 0;
        while (hasUnused(mPath.back())) {
            const std::uint32_t point = mEdges[mNext[mPath.back()]++].to;
            if (mPosition[point] == kNoIndex) {
                mPosition[point] = static_cast<std::uint32_t>(mPath.size());
                mPath.push_back(point);
                continue;
            }
            // Cut off the loop that has just closed, and go on from where it did.
            const auto first = mPath.begin() + mPosition[point];
            mLoop.assign(first, mPath.end());
            visit(mLoop);
            for (auto p = first + 1; p != mPath.end(); ++p) mPosition[*p] = kNoIndex;
            mPath.erase(first + 1, mPath.end());
        }
        assert(mPath.size() == 1);
        mPosition[start] = kNoIndex;
    }

    const std::vector<BoundaryEdge>& mEdges;
    std::size_t mEnd = 0;
    std::vector<std::uint32_t> mNext;      ///< first unused edge from a point
    std::vector<std::uint32_t> mPosition;  ///< of a point in the path
    std::vector<std::uint32_t> mPath;
    std::vector<std::uint32_t> mLoop;
};

CappedHole capLoop(const std::vector<std::uint32_t>& loop, std::uint32_t component, Mesh& mesh,
                   MeshComponents& components) {
    CappedHole hole;
    hole.edges = loop.size();
    hole.center = openvdb::Vec3d(0.0);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const openvdb::Vec3d& p = mesh.points[loop[i]];
        hole.perimeter += (mesh.points[loop[(i + 1) % loop.size()]] - p).length();
        hole.center += p / static_cast<double>(loop.size());
    }

    // The cap runs along the loop against the direction of the piece.
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.emplace_back(c, b, a);
        components.ofTriangle.push_back(component);
    };
    if (loop.size() == 3) {
        add(loop[0], loop[1], loop[2]);
        return hole;
    }
    std::vector<openvdb::Vec3d> points;
    points.reserve(loop.size());
    for (const std::uint32_t p : loop) points.push_back(mesh.points[p]);
    const std::vector<openvdb::Vec3I> cap = triangulateLoop(points);
    for (const openvdb::Vec3I& t : cap) add(loop[t[0]], loop[t[1]], loop[t[2]]);
    if (!cap.empty()) return hole;

    // Where that fails, a fan closes it all the same.
    const auto center = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(hole.center);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        add(loop[i], loop[(i + 1) % loop.size()], center);
    }
    return hole;
}

}  // namespace

std::vector<HoleOfPiece> capHoles(Mesh& mesh, MeshComponents& components) {
    std::vector<HoleOfPiece> holes;
    const std::vector<BoundaryEdge>& edges = components.boundary;
    LoopFinder finder(edges, mesh.points.size());
    for (std::size_t begin = 0; begin < edges.size();) {
        const std::uint32_t component = edges[begin].component;
        std::size_t end = begin;
        while (end < edges.size() && edges[end].component == component) ++end;
        finder.findLoops(begin, end, [&](const std::vector<std::uint32_t>& loop) {
            holes.push_back({component, capLoop(loop, component, mesh, components)});
        });
        begin = end;
    }
    return holes;
}

}  // namespace bandvox

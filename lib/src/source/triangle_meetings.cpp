#include "source/triangle_meetings.h"

#include "source/box_pairs.h"
#include "source/certain_turn.h"
#include "source/index_blocks.h"
#include "source/unfolded_stars.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

template <typename K>
typename K::Point_3 pointOf(const Mesh& mesh, std::uint32_t point) {
    const openvdb::Vec3d& p = mesh.points[point];
    return {p.x(), p.y(), p.z()};
}

template <typename K>
typename K::Triangle_3 triangleOf(const Mesh& mesh, std::uint32_t triangle) {
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return {pointOf<K>(mesh, t[0]), pointOf<K>(mesh, t[1]), pointOf<K>(mesh, t[2])};
}

/// Decides which of two triangles whose boxes meet do so themselves.
class MeetingTest {
  public:
    /// `facings`: those of certainFacings; what faces somewhere has an area.
    MeetingTest(const Mesh& mesh, const std::vector<std::uint8_t>& facings)
        : mMesh(mesh), mNoArea(mesh.triangles.size()) {
        forEachIndex(mNoArea.size(), [&](std::size_t i) {
            const auto triangle = static_cast<std::uint32_t>(i);
            mNoArea[i] = facings[i] == 0 && hasNoArea(mesh, triangle) ? 1 : 0;
        });
    }

    std::optional<TriangleMeeting> operator()(const Pair& pair) const {
        const auto [a, b] = pair;
        if (mNoArea[a] != 0 || mNoArea[b] != 0) {
            // They bring no area of their own, but a point on the other's edge.
            if (mNoArea[a] != 0 && mNoArea[b] != 0) return std::nullopt;
            return touchesLine(a, b) ? std::optional(TriangleMeeting{a, b, false}) : std::nullopt;
        }
        const Shared shared = sharedCorners(a, b);
        switch (shared.count) {
            case 0:
                return apart(a, b);
            case 1:
                return aroundCorner(a, b, shared);
            case 2:
                return aroundEdge(a, b, shared);
            default:
                return TriangleMeeting{a, b, true};
        }
    }

  private:
    /// Corners, by their place in either triangle, that two triangles have in common.
    struct Shared {
        int count = 0;
        std::array<int, 3> inA{}, inB{};
    };

    Shared sharedCorners(std::uint32_t a, std::uint32_t b) const {
        Shared shared;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (mMesh.triangles[a][i] != mMesh.triangles[b][j]) continue;
                shared.inA[shared.count] = i;
                shared.inB[shared.count++] = j;
            }
        }
        return shared;
    }

    Kernel::Point_3 corner(std::uint32_t triangle, int i) const {
        return pointOf<Kernel>(mMesh, mMesh.triangles[triangle][i % 3]);
    }

    CGAL::Orientation side(std::uint32_t triangle, const Kernel::Point_3& point) const {
        return CGAL::orientation(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2),
                                 point);
    }

    /// The side of `triangle` on which all of three points lie, or none.
    std::optional<CGAL::Orientation> commonSide(
        std::uint32_t triangle, const std::array<Kernel::Point_3, 3>& points) const {
        const CGAL::Orientation first = side(triangle, points[0]);
        for (int i = 1; i < 3; ++i) {
            if (side(triangle, points[i]) != first) return std::nullopt;
        }
        return first;
    }

    std::array<Kernel::Point_3, 3> corners(std::uint32_t t) const {
        return {corner(t, 0), corner(t, 1), corner(t, 2)};
    }

    std::optional<TriangleMeeting> apart(std::uint32_t a, std::uint32_t b) const {
        const auto ofB = commonSide(a, corners(b));
        if (ofB && *ofB != CGAL::COPLANAR) return std::nullopt;
        const auto ofA = commonSide(b, corners(a));
        if (ofA && *ofA != CGAL::COPLANAR) return std::nullopt;
        if (!CGAL::do_intersect(triangleOf<Kernel>(mMesh, a), triangleOf<Kernel>(mMesh, b))) {
            return std::nullopt;
        }
        return TriangleMeeting{a, b, ofB.has_value() && overlap(a, b)};
    }

    std::optional<TriangleMeeting> aroundCorner(std::uint32_t a, std::uint32_t b,
                                                const Shared& shared) const {
        const auto sides = [&](std::uint32_t of, std::uint32_t other, int common) {
            return std::pair(side(of, corner(other, common + 1)),
                             side(of, corner(other, common + 2)));
        };
        const auto [b1, b2] = sides(a, b, shared.inB[0]);
        if (b1 == b2 && b1 != CGAL::COPLANAR) return std::nullopt;
        const auto [a1, a2] = sides(b, a, shared.inA[0]);
        if (a1 == a2 && a1 != CGAL::COPLANAR) return std::nullopt;
        // Being convex, what they have in common is the corner alone or reaches to where one of the
        // edges opposite it meets the other triangle.
        if (!edgeMeets(b, shared.inB[0], a) && !edgeMeets(a, shared.inA[0], b)) return std::nullopt;
        const bool coplanar = b1 == b2 && b1 == CGAL::COPLANAR;
        return TriangleMeeting{a, b, coplanar && overlap(a, b)};
    }

    std::optional<TriangleMeeting> aroundEdge(std::uint32_t a, std::uint32_t b,
                                              const Shared& shared) const {
        const auto opposite = [](const std::array<int, 3>& common) {
            return 3 - common[0] - common[1];
        };
        const Kernel::Point_3 apexB = corner(b, opposite(shared.inB));
        if (side(a, apexB) != CGAL::COPLANAR) return std::nullopt;
        const CGAL::Orientation fold =
            CGAL::coplanar_orientation(corner(a, shared.inA[0]), corner(a, shared.inA[1]),
                                       corner(a, opposite(shared.inA)), apexB);
        return fold == CGAL::POSITIVE ? std::optional(TriangleMeeting{a, b, true}) : std::nullopt;
    }

    /// True if the edge opposite a corner meets the other triangle.
    bool edgeMeets(std::uint32_t of, int opposite, std::uint32_t other) const {
        return CGAL::do_intersect(
            triangleOf<Kernel>(mMesh, other),
            Kernel::Segment_3(corner(of, opposite + 1), corner(of, opposite + 2)));
    }

    /// True if coplanar triangles have an area in common.
    bool overlap(std::uint32_t a, std::uint32_t b) const {
        const auto common =
            CGAL::intersection(triangleOf<Exact>(mMesh, a), triangleOf<Exact>(mMesh, b));
        return common && boost::get<Exact::Point_3>(&*common) == nullptr &&
               boost::get<Exact::Segment_3>(&*common) == nullptr;
    }

    /// True if of two triangles the one without area touches the other.
    bool touchesLine(std::uint32_t a, std::uint32_t b) const {
        if (sharedCorners(a, b).count > 0) return true;
        if (mNoArea[a] == 0) std::swap(a, b);
        const auto triangle = triangleOf<Kernel>(mMesh, b);
        for (int i = 0; i < 3; ++i) {
            const Kernel::Segment_3 edge(corner(a, i), corner(a, i + 1));
            if (CGAL::do_intersect(triangle, edge)) return true;
        }
        return false;
    }

    const Mesh& mMesh;
    std::vector<char> mNoArea;
};

/// Passes over what certainly meets nowhere but in corners and edges, without exact arithmetic.
class QuickTest {
  public:
    explicit QuickTest(const Mesh& mesh)
        : mMesh(mesh),
          mFacings(certainFacings(mesh)),
          mUnfolded(findUnfoldedStars(mesh, mFacings)) {}

    const std::vector<std::uint8_t>& facings() const { return mFacings; }
    /// Triangles that share a point which is not 0 here meet nowhere else.
    const std::vector<std::uint8_t>& unfolded() const { return mUnfolded; }

    /// Of triangles that share none of these points.
    bool areSurelyApart(const Pair& pair) const {
        const auto [a, b] = pair;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (mMesh.triangles[a][i] == mMesh.triangles[b][j]) return false;
            }
        }
        const Corners ofA = corners(a), ofB = corners(b);
        for (int axis = 0; axis < 3; ++axis) {
            if (isEdgeBetween(ofA, mFacings[a], ofB, axis)) return true;
            if (isEdgeBetween(ofB, mFacings[b], ofA, axis)) return true;
        }
        return false;
    }

  private:
    using Corners = std::array<const openvdb::Vec3d*, 3>;

    Corners corners(std::uint32_t triangle) const {
        const openvdb::Vec3I& t = mMesh.triangles[triangle];
        return {&mMesh.points[t[0]], &mMesh.points[t[1]], &mMesh.points[t[2]]};
    }

    /// True if an edge of `own`, seen along an axis, certainly has all of `other` beyond it.
    static bool isEdgeBetween(const Corners& own, unsigned facing, const Corners& other, int axis) {
        const unsigned turn = facing >> (2 * axis) & 3;
        if (turn == 0) return false;
        const int outside = turn == 1 ? -1 : 1;
        const View2 view = viewAlong(axis);
        for (int i = 0; i < 3; ++i) {
            const openvdb::Vec3d &from = *own[i], &to = *own[(i + 1) % 3];
            if (certainTurn(from, to, *other[0], view) == outside &&
                certainTurn(from, to, *other[1], view) == outside &&
                certainTurn(from, to, *other[2], view) == outside) {
                return true;
            }
        }
        return false;
    }

    const Mesh& mMesh;
    std::vector<std::uint8_t> mFacings;
    std::vector<std::uint8_t> mUnfolded;
};

}  // namespace

bool hasNoArea(const Mesh& mesh, std::uint32_t triangle) {
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return CGAL::collinear(pointOf<Kernel>(mesh, t[0]), pointOf<Kernel>(mesh, t[1]),
                           pointOf<Kernel>(mesh, t[2]));
}

std::vector<TriangleMeeting> findMeetings(const Mesh& mesh, Progress& progress) {
    const QuickTest quick(mesh);
    const MeetingTest test(mesh, quick.facings());
    progress.throwIfInterrupted();
    const BoxPairs boxes(mesh, quick.unfolded());
    constexpr std::size_t kLeavesOfTask = 256;
    const std::size_t tasks = (boxes.leafCount() + kLeavesOfTask - 1) / kLeavesOfTask;
    std::vector<std::vector<TriangleMeeting>> found(tasks);
    std::atomic<std::size_t> count = 0;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        const std::size_t first = static_cast<std::size_t>(task) * kLeavesOfTask;
        std::vector<Pair> pairs;
        for (std::size_t i = first; i < std::min(first + kLeavesOfTask, boxes.leafCount()); ++i) {
            progress.throwIfInterrupted();
            pairs.clear();
            boxes.appendPairs(i, pairs);
            for (const Pair& pair : pairs) {
                if (quick.areSurelyApart(pair)) continue;
                const auto meeting = test(std::minmax(pair.first, pair.second));
                if (!meeting) continue;
                found[static_cast<std::size_t>(task)].push_back(*meeting);
                // There may be more of them than the memory holds: each takes about a thousand
                // bytes while it is cut.
                constexpr std::size_t kNowAndThen = 4096;
                const std::size_t known = ++count;
                if (known % kNowAndThen != 0) continue;
                requireMemory(1000.0 * static_cast<double>(known),
                              "the union of so many triangles that cut each other");
            }
        }
    });
    std::vector<TriangleMeeting> meetings;
    for (const auto& part : found) meetings.insert(meetings.end(), part.begin(), part.end());
    std::sort(meetings.begin(), meetings.end(),
              [](const TriangleMeeting& a, const TriangleMeeting& b) {
                  return std::pair(a.first, a.second) < std::pair(b.first, b.second);
              });
    return meetings;
}

}  // namespace bandvox

#include "source/triangle_meetings.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

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
    explicit MeetingTest(const Mesh& mesh) : mMesh(mesh), mNoArea(mesh.triangles.size()) {
        parallelFor(blocks(mNoArea.size()), [&](std::int64_t block) {
            forBlock(block, mNoArea.size(), [&](std::size_t i) {
                mNoArea[i] = hasNoArea(mesh, static_cast<std::uint32_t>(i)) ? 1 : 0;
            });
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

    static std::int64_t blocks(std::size_t count) {
        return static_cast<std::int64_t>((count + kBlock - 1) / kBlock);
    }

    template <typename Visit>
    static void forBlock(std::int64_t block, std::size_t count, const Visit& visit) {
        const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
        for (std::size_t i = begin; i < std::min(begin + kBlock, count); ++i) visit(i);
    }

  private:
    static constexpr std::size_t kBlock = 4096;

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

using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t,
                                                      CGAL::Box_intersection_d::ID_EXPLICIT>;

/// The boxes of triangles, by where they begin along the longest side of their common box, cut
/// into groups. A group can meet itself, and those after it that begin before it ends.
class BoxGroups {
  public:
    explicit BoxGroups(const Mesh& mesh) : mBoxes(mesh.triangles.size()) {
        openvdb::BBoxd whole;
        for (const openvdb::Vec3d& point : mesh.points) whole.expand(point);
        mAxis = static_cast<int>(whole.maxExtent());
        for (std::uint32_t i = 0; i < mBoxes.size(); ++i) {
            openvdb::BBoxd box;
            for (int k = 0; k < 3; ++k) box.expand(mesh.points[mesh.triangles[i][k]]);
            const openvdb::Vec3d low = box.min(), high = box.max();
            mBoxes[i] = {{low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}, i};
        }
        std::sort(mBoxes.begin(), mBoxes.end(), [this](const Box& a, const Box& b) {
            const double first = a.min_coord(mAxis), second = b.min_coord(mAxis);
            return first != second ? first < second : a.info() < b.info();
        });
        // Few groups, as one may meet all after it.
        constexpr std::size_t kLeast = 4096, kMostGroups = 64;
        mSize = std::max(kLeast, (mBoxes.size() + kMostGroups - 1) / kMostGroups);
    }

    std::int64_t count() const {
        return static_cast<std::int64_t>((mBoxes.size() + mSize - 1) / mSize);
    }

    /// Calls visit(pair) for each pair of triangles whose boxes meet, the first to begin one of
    /// the group.
    template <typename Visit>
    void forCandidates(std::int64_t group, const Visit& visit) const {
        const std::size_t begin = static_cast<std::size_t>(group) * mSize;
        const std::size_t end = std::min(begin + mSize, mBoxes.size());
        const auto at = [this](std::size_t i) {
            return mBoxes.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::vector<Box> own(at(begin), at(end));
        double last = own.front().max_coord(mAxis);
        for (const Box& box : own) last = std::max(last, box.max_coord(mAxis));
        std::size_t beyond = end;
        while (beyond < mBoxes.size() && mBoxes[beyond].min_coord(mAxis) <= last) ++beyond;
        std::vector<Box> later(at(end), at(beyond));
        // So few boxes are swept over rather than divided further. CGAL's own bound of 10 takes
        // half as long again for a mesh of small triangles.
        constexpr std::ptrdiff_t kSwept = 500;
        const auto found = [&](const Box& a, const Box& b) {
            visit(Pair(std::minmax(a.info(), b.info())));
        };
        CGAL::box_intersection_d(own.begin(), own.end(), later.begin(), later.end(), found, kSwept);
        CGAL::box_self_intersection_d(own.begin(), own.end(), found, kSwept);
    }

  private:
    std::vector<Box> mBoxes;
    int mAxis = 0;
    std::size_t mSize = 0;
};

}  // namespace

bool hasNoArea(const Mesh& mesh, std::uint32_t triangle) {
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return CGAL::collinear(pointOf<Kernel>(mesh, t[0]), pointOf<Kernel>(mesh, t[1]),
                           pointOf<Kernel>(mesh, t[2]));
}

std::vector<TriangleMeeting> findMeetings(const Mesh& mesh, Progress& progress) {
    const MeetingTest test(mesh);
    const BoxGroups groups(mesh);
    std::vector<std::vector<TriangleMeeting>> found(static_cast<std::size_t>(groups.count()));
    std::atomic<std::size_t> count = 0;
    parallelFor(groups.count(), [&](std::int64_t group) {
        std::size_t visited = 0;
        groups.forCandidates(group, [&](const Pair& pair) {
            constexpr std::size_t kNowAndThen = 4096;
            if (visited++ % kNowAndThen == 0) progress.throwIfInterrupted();
            const auto meeting = test(pair);
            if (!meeting) return;
            found[static_cast<std::size_t>(group)].push_back(*meeting);
            // There may be more of them than the memory holds: each takes about a thousand bytes
            // while it is cut.
            const std::size_t known = ++count;
            if (known % kNowAndThen != 0) return;
            requireMemory(1000.0 * static_cast<double>(known),
                          "the union of so many triangles that cut each other");
        });
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

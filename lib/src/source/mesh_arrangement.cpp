#include "source/mesh_arrangement.h"

#include "source/weld_points.h"

#include <bandvox/core/parallel.h>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default,
                                                                 CGAL::Exact_intersections_tag>;
using Point2 = Kernel::Point_2;
using Point3 = Kernel::Point_3;

Point3 pointOf(const Mesh& mesh, std::uint32_t point) {
    const Vec3d& p = mesh.points[point];
    return {p.x(), p.y(), p.z()};
}

Kernel::Triangle_3 triangleOf(const Mesh& mesh, std::uint32_t triangle) {
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return {pointOf(mesh, t[0]), pointOf(mesh, t[1]), pointOf(mesh, t[2])};
}

/// The plane of a triangle, seen along the axis that it is least inclined to.
class Projection {
  public:
    explicit Projection(const Kernel::Triangle_3& triangle)
        : mOrigin(triangle.vertex(0)),
          mNormal(CGAL::cross_product(triangle.vertex(1) - mOrigin, triangle.vertex(2) - mOrigin)) {
        std::array<double, 3> size{};
        for (int i = 0; i < 3; ++i) size[i] = std::abs(CGAL::to_double(mNormal[i]));
        mAxis = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
        // Rounding may have made nothing of a component that is something.
        for (int i = 0; i < 3 && CGAL::is_zero(mNormal[mAxis]); ++i) mAxis = i;
        mU = (mAxis + 1) % 3;
        mV = (mAxis + 2) % 3;
    }

    Point2 flat(const Point3& p) const { return {p[mU], p[mV]}; }

    /// The point of the plane above p, rounded.
    Vec3d lifted(const Point2& p) const {
        const Kernel::FT along = mOrigin[mAxis] - (mNormal[mU] * (p.x() - mOrigin[mU]) +
                                                   mNormal[mV] * (p.y() - mOrigin[mV])) /
                                                      mNormal[mAxis];
        Vec3d point;
        point[mAxis] = rounded(along);
        point[mU] = rounded(p.x());
        point[mV] = rounded(p.y());
        return point;
    }

  private:
    /// Depends on the number alone, not on how it came about.
    static double rounded(const Kernel::FT& x) { return CGAL::to_double(CGAL::exact(x)) + 0.0; }

    Point3 mOrigin;
    Kernel::Vector_3 mNormal;
    int mAxis, mU, mV;
};

/// Triangles of one plane that cover each other, and what meets them: cut up together.
class Facet {
  public:
    Facet(const Mesh& mesh, const std::vector<std::uint32_t>& triangles)
        : mMesh(mesh), mProjection(triangleOf(mesh, triangles.front())) {
        for (const std::uint32_t t : triangles) {
            mTriangles.push_back(triangleOf(mesh, t));
            std::array<Point2, 3> corners;
            for (int i = 0; i < 3; ++i) corners[i] = mProjection.flat(mTriangles.back().vertex(i));
            mCorners.push_back(corners);
            mFacing.push_back(CGAL::orientation(corners[0], corners[1], corners[2]));
            for (int i = 0; i < 3; ++i) insertEdge(corners[i], corners[(i + 1) % 3]);
        }
    }

    /// Cuts where another triangle meets one of this facet's.
    void cut(std::size_t own, std::uint32_t other, bool otherHasNoArea) {
        const Kernel::Triangle_3 triangle = triangleOf(mMesh, other);
        if (otherHasNoArea) {
            for (int i = 0; i < 3; ++i) {
                insert(CGAL::intersection(
                    mTriangles[own],
                    Kernel::Segment_3(triangle.vertex(i), triangle.vertex((i + 1) % 3))));
            }
            return;
        }
        insert(CGAL::intersection(mTriangles[own], triangle));
    }

    /// Calls emit(corners, layers) for each piece that counts.
    template <typename Emit>
    void forEachPiece(const Emit& emit) const {
        for (auto face = mCut.finite_faces_begin(); face != mCut.finite_faces_end(); ++face) {
            std::array<Point2, 3> corners;
            for (int i = 0; i < 3; ++i) corners[i] = face->vertex(i)->point();
            const int layers = layersAt(CGAL::centroid(corners[0], corners[1], corners[2]));
            if (layers == 0) continue;
            std::array<Vec3d, 3> piece;
            for (int i = 0; i < 3; ++i) piece[i] = mProjection.lifted(corners[i]);
            if (layers < 0) std::swap(piece[1], piece[2]);
            emit(piece, std::abs(layers));
        }
    }

  private:
    void insertEdge(const Point2& a, const Point2& b) {
        if (a == b) {
            mCut.insert(a);
        } else {
            mCut.insert_constraint(a, b);
        }
    }

    template <typename Common>
    void insert(const Common& common) {
        if (common)
            boost::apply_visitor([this](const auto& shape) { insertShape(shape); }, *common);
    }
    void insertShape(const Point3& p) { mCut.insert(mProjection.flat(p)); }
    void insertShape(const Kernel::Segment_3& s) {
        insertEdge(mProjection.flat(s.source()), mProjection.flat(s.target()));
    }
    void insertShape(const Kernel::Triangle_3& t) {
        for (int i = 0; i < 3; ++i) {
            insertEdge(mProjection.flat(t.vertex(i)), mProjection.flat(t.vertex((i + 1) % 3)));
        }
    }
    void insertShape(const std::vector<Point3>& polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            insertEdge(mProjection.flat(polygon[i]),
                       mProjection.flat(polygon[(i + 1) % polygon.size()]));
        }
    }

    int layersAt(const Point2& p) const {
        int layers = 0;
        for (std::size_t t = 0; t < mCorners.size(); ++t) {
            const auto& c = mCorners[t];
            bool inside = true;
            for (int i = 0; i < 3 && inside; ++i) {
                inside = CGAL::orientation(c[i], c[(i + 1) % 3], p) == mFacing[t];
            }
            if (inside) layers += mFacing[t] == CGAL::POSITIVE ? 1 : -1;
        }
        return layers;
    }

    const Mesh& mMesh;
    Projection mProjection;
    std::vector<Kernel::Triangle_3> mTriangles;
    std::vector<std::array<Point2, 3>> mCorners;
    std::vector<CGAL::Orientation> mFacing;
    Triangulation mCut;
};

/// Sets of triangles, joined one by one.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : mParent(count) {
        std::iota(mParent.begin(), mParent.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (mParent[i] != i) i = mParent[i] = mParent[mParent[i]];
        return i;
    }
    /// The lower of the two stands for both.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        mParent[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> mParent;
};

/// A triangle to be cut, what stands for its facet, and the range of its meetings.
struct CutTriangle {
    std::uint32_t facet, triangle;
    std::size_t begin, end;
};

/// All meetings from the side of each triangle, those of equal ones side by side.
std::vector<TriangleMeeting> fromBothSides(const std::vector<TriangleMeeting>& meetings) {
    std::vector<TriangleMeeting> both = meetings;
    for (const TriangleMeeting& m : meetings) both.push_back({m.second, m.first, m.coplanar});
    std::sort(both.begin(), both.end(), [](const TriangleMeeting& a, const TriangleMeeting& b) {
        return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    return both;
}

/// What one task makes of its facets.
struct Pieces {
    std::vector<std::array<Vec3d, 3>> corners;
    std::vector<int> layers;
};

}  // namespace

MeshArrangement arrangeMesh(Mesh mesh, const std::vector<TriangleMeeting>& meetings,
                            Progress& progress) {
    MeshArrangement result;
    result.layers.assign(mesh.triangles.size(), 1);
    if (meetings.empty()) {
        result.mesh = std::move(mesh);
        return result;
    }

    // Find the triangles that are cut, and which of them cover each other.
    const std::vector<TriangleMeeting> both = fromBothSides(meetings);
    DisjointSets sets(mesh.triangles.size());
    for (const TriangleMeeting& m : meetings) {
        if (m.coplanar) sets.join(m.first, m.second);
    }
    std::vector<CutTriangle> cut;
    std::vector<char> isCut(mesh.triangles.size(), 0);
    for (std::size_t begin = 0; begin < both.size();) {
        std::size_t end = begin;
        const std::uint32_t triangle = both[begin].first;
        while (end < both.size() && both[end].first == triangle) ++end;
        isCut[triangle] = 1;
        // What has no area leaves nothing.
        if (!hasNoArea(mesh, triangle)) {
            cut.push_back({sets.find(triangle), triangle, begin, end});
        }
        begin = end;
    }
    result.trianglesCut = cut.size();
    std::stable_sort(cut.begin(), cut.end(),
                     [](const CutTriangle& a, const CutTriangle& b) { return a.facet < b.facet; });
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < cut.size(); ++i) {
        if (i == 0 || cut[i].facet != cut[i - 1].facet) starts.push_back(i);
    }
    starts.push_back(cut.size());

    // Cut up each facet. Exact numbers stay within their task.
    std::vector<Pieces> pieces(starts.size() - 1);
    const ProgressStage stage(progress, "cutting", static_cast<std::int64_t>(pieces.size()));
    parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        std::vector<std::uint32_t> triangles;
        for (std::size_t c = starts[i]; c < starts[i + 1]; ++c)
            triangles.push_back(cut[c].triangle);
        Facet facet(mesh, triangles);
        for (std::size_t c = starts[i]; c < starts[i + 1]; ++c) {
            for (std::size_t m = cut[c].begin; m < cut[c].end; ++m) {
                // What lies in the facet has its own edges there already.
                if (both[m].coplanar) continue;
                facet.cut(c - starts[i], both[m].second, hasNoArea(mesh, both[m].second));
            }
        }
        facet.forEachPiece([&](const std::array<Vec3d, 3>& corners, int layers) {
            pieces[i].corners.push_back(corners);
            pieces[i].layers.push_back(layers);
        });
        progress.advance();
    });

    // Put the pieces into the place of what was cut, and join equal points.
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (isCut[t] == 0) mesh.triangles[kept++] = mesh.triangles[t];
    }
    mesh.triangles.resize(kept);
    result.layers.resize(kept);
    for (const Pieces& part : pieces) {
        for (std::size_t i = 0; i < part.corners.size(); ++i) {
            const auto first = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.insert(mesh.points.end(), part.corners[i].begin(), part.corners[i].end());
            mesh.triangles.emplace_back(first, first + 1, first + 2);
            result.layers.push_back(part.layers[i]);
        }
    }
    weldPoints(mesh, 0);
    kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const openvdb::Vec3I& c = mesh.triangles[t];
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        mesh.triangles[kept] = c;
        result.layers[kept++] = result.layers[t];
    }
    mesh.triangles.resize(kept);
    result.layers.resize(kept);
    result.mesh = std::move(mesh);
    return result;
}

}  // namespace bandvox

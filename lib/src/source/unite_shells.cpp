#include "core/words.h"
#include "source/box_tree.h"
#include "source/directed_edges.h"
#include "source/mesh_arrangement.h"
#include "source/no_index.h"
#include "source/ray_crossing.h"
#include "source/triangle_neighbors.h"
#include "source/weld_points.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/unite_shells.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;
using openvdb::Vec3I;

/// Parts of the surface that no other part meets but at their borders. All of a patch has the same
/// number of layers, and the same winding numbers on its two sides.
ConnectedTriangles findPatches(const Mesh& mesh) {
    const DirectedEdges edges(mesh);
    return connectNeighbors(findNeighbors(edges, listEdges(edges, mesh.points.size())));
}

/// Coordinates from those that follow `axis`, so that it becomes x.
Vec3d turned(const Vec3d& v, int axis) {
    return {v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

/// Where a patch is looked at from: the middle of a triangle, along an axis.
struct View {
    std::uint32_t triangle = kNoIndex;
    int axis = 0;
    double area = -1;  ///< of the triangle as seen along the axis
};

/// Finds how often the surface winds around the two sides of each patch.
class Windings {
  public:
    Windings(const MeshArrangement& arrangement, const ConnectedTriangles& patches)
        : mMesh(arrangement.mesh), mLayers(arrangement.layers), mViews(patches.count) {
        // What is seen largest is the least likely to lie where rounding decides.
        for (std::uint32_t t = 0; t < mMesh.triangles.size(); ++t) {
            const std::array<Vec3d, 3> c = corners(t, 0);
            const Vec3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
            View& view = mViews[patches.setOf[t]];
            for (int axis = 0; axis < 3; ++axis) {
                // One axis takes one search tree: stay with the first unless another is far better.
                const double area = (axis == 0 ? 16 : 1) * std::abs(normal[axis]);
                if (area > view.area) view = {t, axis, area};
            }
        }
        std::array<bool, 3> needed{};
        for (const View& view : mViews) needed[view.axis] = true;
        for (int axis = 0; axis < 3; ++axis) {
            if (needed[axis]) mTrees[axis] = std::make_unique<BoxTree>(boxes(axis));
        }
    }

    /// The winding number outside of patch i, on the side that its triangles face.
    int outside(std::size_t i) const {
        const View& view = mViews[i];
        const std::array<Vec3d, 3> own = corners(view.triangle, view.axis);
        const Vec3d point = (own[0] + own[1] + own[2]) / 3.0;
        int ahead = 0;  // between the patch and what is next along the axis
        mTrees[view.axis]->visitAlongX(point, [&](std::uint32_t t) {
            if (t == view.triangle) return;
            ahead += mLayers[t] * rayCrossing(point, corners(t, view.axis));
        });
        const bool facesAlong = (own[1] - own[0]).cross(own[2] - own[0]).x() > 0;
        return facesAlong ? ahead : ahead - mLayers[view.triangle];
    }

    int layers(std::size_t i) const { return mLayers[mViews[i].triangle]; }

  private:
    std::array<Vec3d, 3> corners(std::uint32_t t, int axis) const {
        std::array<Vec3d, 3> c;
        for (int i = 0; i < 3; ++i) c[i] = turned(mMesh.points[mMesh.triangles[t][i]], axis);
        return c;
    }

    std::vector<BBoxd> boxes(int axis) const {
        std::vector<BBoxd> result(mMesh.triangles.size());
        for (std::uint32_t t = 0; t < result.size(); ++t) {
            for (const Vec3d& corner : corners(t, axis)) result[t].expand(corner);
        }
        return result;
    }

    const Mesh& mMesh;
    const std::vector<int>& mLayers;
    std::vector<View> mViews;
    std::array<std::unique_ptr<BoxTree>, 3> mTrees;
};

/// Which patches stay, and which of them are turned.
enum class Fate : char { Dropped, Kept, Turned };

std::vector<Fate> decide(const MeshArrangement& arrangement, const ConnectedTriangles& patches,
                         Progress& progress) {
    const Windings windings(arrangement, patches);
    std::vector<Fate> fates(patches.count, Fate::Dropped);
    parallelFor(static_cast<std::int64_t>(patches.count), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int outside = windings.outside(static_cast<std::size_t>(i));
        const int inside = outside + windings.layers(static_cast<std::size_t>(i));
        if (inside >= 1 && outside < 1) fates[i] = Fate::Kept;
        if (inside < 1 && outside >= 1) fates[i] = Fate::Turned;
    });
    return fates;
}

/// Keeps the triangles of patches that stay. Returns how many went.
std::size_t keepPatches(Mesh& mesh, const ConnectedTriangles& patches,
                        const std::vector<Fate>& fates) {
    const std::size_t before = mesh.triangles.size();
    std::size_t kept = 0;
    for (std::size_t t = 0; t < before; ++t) {
        const Fate fate = fates[patches.setOf[t]];
        if (fate == Fate::Dropped) continue;
        Vec3I triangle = mesh.triangles[t];
        if (fate == Fate::Turned) std::swap(triangle[1], triangle[2]);
        mesh.triangles[kept++] = triangle;
    }
    mesh.triangles.resize(kept);
    removeUnusedPoints(mesh);
    return before - kept;
}

/// True if every directed edge has its opposite.
bool isClosed(const Mesh& mesh) {
    const DirectedEdges edges(mesh);
    std::atomic<bool> closed = true;
    forEachGroupInBlocks(edges, listEdges(edges, mesh.points.size()),
                         [&](std::size_t, std::span<const std::uint32_t> group) {
                             int net = 0;
                             for (const std::uint32_t e : group) net += edges.rises(e) ? 1 : -1;
                             if (net != 0) closed = false;
                         });
    return closed;
}

}  // namespace

UnitedMesh uniteShells(Mesh mesh, Progress& progress) {
    UnitedMesh united;
    UnionReport& report = united.report;
    std::vector<TriangleMeeting> meetings;
    {
        const ProgressStage stage(progress, "find overlaps", 0);
        meetings = findMeetings(mesh, progress);
    }
    report.meetings = meetings.size();
    Mesh original;
    if (!meetings.empty()) original = mesh;
    MeshArrangement arrangement = arrangeMesh(std::move(mesh), meetings, progress);
    report.trianglesCut = arrangement.trianglesCut;

    // Drop what is inside, or bounds nothing.
    const ConnectedTriangles patches = findPatches(arrangement.mesh);
    if (meetings.empty() && patches.count == 1) {
        united.mesh = std::move(arrangement.mesh);
        return united;
    }
    const std::vector<Fate> fates = decide(arrangement, patches, progress);
    if (meetings.empty()) original = arrangement.mesh;
    report.trianglesDropped = keepPatches(arrangement.mesh, patches, fates);
    united.mesh = std::move(arrangement.mesh);
    if (united.mesh.triangles.empty()) {
        throw Error(ErrorKind::Result,
                    "the mesh winds around nothing: its shells cancel each other out");
    }
    // A wrong winding number, of a sliver that rounding has turned over, shows in what it leaves
    // open.
    if (!isClosed(united.mesh)) {
        united.mesh = std::move(original);
        report.trianglesDropped = 0;
        report.warnings.push_back("shells overlap in a way that could not be cut; they add up");
        return united;
    }
    if (report.trianglesDropped > 0) {
        report.warnings.push_back(
            "shells overlap: " + counted(report.trianglesDropped, "triangle", "triangles") +
            " inside the solid, whole or in pieces, " +
            (report.trianglesDropped == 1 ? "was" : "were") + " dropped to make their union");
    }
    return united;
}

}  // namespace bandvox

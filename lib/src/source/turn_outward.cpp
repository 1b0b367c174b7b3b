#include "source/turn_outward.h"

#include "source/box_tree.h"
#include "source/compensated_sum.h"
#include "source/ray_crossing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;
using openvdb::Vec3I;

/// Volume, relative to area times size, below which a piece counts as flat.
constexpr double kFlatPiece = 1e-12;

/// A closed piece as a whole.
struct Piece {
    BBoxd box;
    double volume = 0;
    double area = 0;
    std::uint32_t largestTriangle = 0;

    bool insideOut() const { return volume < -kFlatPiece * area * box.extents().length(); }
};

std::vector<Piece> measurePieces(const Mesh& mesh, const MeshComponents& components) {
    std::vector<Piece> pieces(components.count);
    std::vector<Vec3d> origin(components.count);
    std::vector<CompensatedSum> volume(components.count);
    std::vector<double> largest(components.count, -1.0);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t c = components.ofTriangle[i];
        const Vec3I& t = mesh.triangles[i];
        Piece& piece = pieces[c];
        if (largest[c] < 0.0) origin[c] = mesh.points[t[0]];
        for (int k = 0; k < 3; ++k) piece.box.expand(mesh.points[t[k]]);
        const Vec3d a = mesh.points[t[0]] - origin[c];
        const Vec3d normal =
            (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
        volume[c].add(a.dot(normal) / 6.0);
        const double area = 0.5 * normal.length();
        piece.area += area;
        if (area > largest[c]) {
            largest[c] = area;
            piece.largestTriangle = i;
        }
    }
    for (std::size_t c = 0; c < pieces.size(); ++c) pieces[c].volume = volume[c].value();
    return pieces;
}

/// Finds which closed pieces hold a point.
class Containment {
  public:
    Containment(const Mesh& mesh, const MeshComponents& components,
                const std::vector<Piece>& pieces)
        : mMesh(mesh),
          mComponents(components),
          mPieces(pieces),
          mTree(triangleBoxes(mesh, pieces.size() > 1)) {}

    /// The largest piece that holds piece c, or c itself.
    std::size_t outermost(std::size_t c) const {
        if (mPieces.size() == 1) return c;
        // The middle of a large triangle is the least likely to be shared with another piece.
        const std::array<Vec3d, 3> triangle = corners(mPieces[c].largestTriangle);
        const Vec3d point = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        std::map<std::uint32_t, int> winding;
        mTree.visitAlongX(point, [&](std::uint32_t t) {
            const std::uint32_t other = mComponents.ofTriangle[t];
            if (other != c && mPieces[other].box.isInside(mPieces[c].box)) {
                winding[other] += rayCrossing(point, corners(t));
            }
        });
        std::size_t result = c;
        for (const auto& [other, count] : winding) {
            if (count != 0 && std::abs(mPieces[other].volume) > std::abs(mPieces[result].volume)) {
                result = other;
            }
        }
        return result;
    }

  private:
    /// The boxes to search; none where there is nothing to search for.
    static std::vector<BBoxd> triangleBoxes(const Mesh& mesh, bool needed) {
        std::vector<BBoxd> boxes(needed ? mesh.triangles.size() : 0);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (int k = 0; k < 3; ++k) boxes[i].expand(mesh.points[mesh.triangles[i][k]]);
        }
        return boxes;
    }

    std::array<Vec3d, 3> corners(std::uint32_t i) const {
        const Vec3I& t = mMesh.triangles[i];
        return {mMesh.points[t[0]], mMesh.points[t[1]], mMesh.points[t[2]]};
    }

    const Mesh& mMesh;
    const MeshComponents& mComponents;
    const std::vector<Piece>& mPieces;
    BoxTree mTree;
};

}  // namespace

TurnedComponents turnOutward(Mesh& mesh, const MeshComponents& components) {
    const std::vector<Piece> pieces = measurePieces(mesh, components);
    const auto insideOut = [](const Piece& piece) { return piece.insideOut(); };
    if (std::none_of(pieces.begin(), pieces.end(), insideOut)) return {};

    std::vector<char> turn;
    const Containment containment(mesh, components, pieces);
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        turn.push_back(pieces[containment.outermost(c)].insideOut() ? 1 : 0);
    }

    TurnedComponents turned;
    turned.components = static_cast<std::size_t>(std::count(turn.begin(), turn.end(), 1));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (turn[components.ofTriangle[i]] == 0) continue;
        std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
        ++turned.triangles;
    }
    return turned;
}

}  // namespace bandvox

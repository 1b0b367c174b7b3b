#include "source/separate_soup.h"

#include "source/orient_by_rays.h"
#include "source/weld_points.h"

#include <bandvox/source/winding_number.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;
using openvdb::Vec3I;

// Caps of less than this part of the mesh's area are not looked at.
constexpr double kLeastCaps = 0.01;

// So many caps of a piece, the largest, and so many pieces are looked at.
constexpr std::size_t kCapsOfPiece = 8;
constexpr std::size_t kMostPieces = 1000;

// The winding number is clear if it is this far from 0.5.
constexpr double kClearWinding = 0.25;

// A piece is soup if this part of its caps' area is wrong.
constexpr double kMostWrong = 0.25;

// A piece whose volume, relative to its area, is at least this tells what its outside is.
constexpr double kRound = 0.02;

// Sides of a cap are looked at this far from it, relative to its own size and to the mesh's.
constexpr double kAsideOfCap = 0.1;
constexpr double kAsideOfMesh = 1e-3;

struct OpenPiece {
    double area = 0;    // without caps
    double volume = 0;  // caps included
    double capArea = 0;
    std::vector<std::uint32_t> caps;  // the largest first

    bool isRound() const { return std::abs(volume) > kRound * std::pow(area + capArea, 1.5); }
};

Vec3d areaVector(const Mesh& mesh, const Vec3I& t) {
    const Vec3d& a = mesh.points[t[0]];
    return 0.5 * (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
}

std::vector<OpenPiece> measure(const Mesh& mesh, const MeshComponents& components,
                               std::size_t firstCap) {
    std::vector<OpenPiece> pieces(components.count);
    std::vector<std::optional<Vec3d>> origin(components.count);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t c = components.ofTriangle[i];
        OpenPiece& piece = pieces[c];
        const Vec3d area = areaVector(mesh, mesh.triangles[i]);
        const Vec3d& corner = mesh.points[mesh.triangles[i][0]];
        if (!origin[c]) origin[c] = corner;
        piece.volume += (corner - *origin[c]).dot(area) / 3;
        (i < firstCap ? piece.area : piece.capArea) += area.length();
        if (i >= firstCap) piece.caps.push_back(i);
    }
    for (OpenPiece& piece : pieces) {
        const std::size_t kept = std::min(piece.caps.size(), kCapsOfPiece);
        std::partial_sort(piece.caps.begin(),
                          piece.caps.begin() + static_cast<std::ptrdiff_t>(kept), piece.caps.end(),
                          [&](std::uint32_t a, std::uint32_t b) {
                              return std::pair(-areaVector(mesh, mesh.triangles[a]).length(), a) <
                                     std::pair(-areaVector(mesh, mesh.triangles[b]).length(), b);
                          });
        piece.caps.resize(kept);
    }
    return pieces;
}

BBoxd boxOf(const Mesh& mesh) {
    BBoxd box;
    for (const Vec3d& p : mesh.points) box.expand(p);
    return box;
}

// True if most of the surface without its caps looks towards the middle.
bool facesInward(const Mesh& mesh, std::size_t firstCap) {
    const Vec3d middle = boxOf(mesh).getCenter();
    double outward = 0;
    for (std::size_t i = 0; i < firstCap; ++i) {
        const Vec3I& t = mesh.triangles[i];
        outward += areaVector(mesh, t).dot(mesh.points[t[0]] - middle);
    }
    return outward < 0;
}

// Compares what the caps say with what the surface without them does.
class CapJudge {
  public:
    CapJudge(const Mesh& mesh, std::size_t firstCap)
        : mMesh(mesh),
          mOpen(part(mesh, 0, firstCap)),
          mCaps(part(mesh, firstCap, mesh.triangles.size())) {
        mAside = kAsideOfMesh * boxOf(mesh).extents().length();
        mSign = facesInward(mesh, firstCap) ? -1 : 1;
    }

    bool isInsideOut() const { return mSign < 0; }

    // The part of a piece's caps, by area, that is wrong.
    double wrongPart(const OpenPiece& piece) const {
        double wrong = 0, all = 0;
        for (const std::uint32_t cap : piece.caps) {
            const Vec3I& t = mMesh.triangles[cap];
            const Vec3d area = areaVector(mMesh, t);
            const double size = area.length();
            if (size == 0) continue;
            all += size;
            const Vec3d middle =
                (mMesh.points[t[0]] + mMesh.points[t[1]] + mMesh.points[t[2]]) / 3.0;
            const Vec3d aside = std::min(mAside, kAsideOfCap * std::sqrt(size)) / size * area;
            if (isWrong(middle + aside) || isWrong(middle - aside)) wrong += size;
        }
        return all > 0 ? wrong / all : 0;
    }

  private:
    static Mesh part(const Mesh& mesh, std::size_t begin, std::size_t end) {
        Mesh result;
        result.points = mesh.points;
        result.triangles.assign(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                                mesh.triangles.begin() + static_cast<std::ptrdiff_t>(end));
        removeUnusedPoints(result);
        return result;
    }

    // True if the place is clearly inside by the surface alone and outside with the caps, or the
    // other way round.
    bool isWrong(const Vec3d& place) const {
        const double open = mOpen.at(place);
        if (std::abs(mSign * open - 0.5) < kClearWinding) return false;
        const double capped = open + mCaps.at(place);
        return (mSign * open > 0.5) != (std::abs(capped) > 0.5);
    }

    const Mesh& mMesh;
    WindingNumber mOpen, mCaps;
    double mAside = 0;
    int mSign = 1;
};

// Which pieces are soup.
std::vector<char> judge(const std::vector<OpenPiece>& pieces, const CapJudge& caps) {
    std::vector<std::size_t> open;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        if (!pieces[c].caps.empty()) open.push_back(c);
    }
    std::vector<char> isSoup(pieces.size(), 0);
    const std::size_t step = (open.size() + kMostPieces - 1) / kMostPieces;
    double wrongArea = 0, lookedAt = 0;
    for (std::size_t i = 0; i < open.size(); i += step) {
        const OpenPiece& piece = pieces[open[i]];
        isSoup[open[i]] = caps.wrongPart(piece) > kMostWrong ? 1 : 0;
        lookedAt += piece.capArea;
        if (isSoup[open[i]] != 0) wrongArea += piece.capArea;
    }
    if (step <= 1) return isSoup;
    const bool areMostSoup = wrongArea > kMostWrong * lookedAt;
    for (const std::size_t c : open) isSoup[c] = areMostSoup ? 1 : 0;
    return isSoup;
}

// Splits a mesh. What a round piece encloses tells its outside; others face as they did, or the
// other way.
SeparatedSoup split(Mesh& mesh, MeshComponents& components, std::size_t firstCap,
                    const std::vector<OpenPiece>& pieces, std::vector<char> isSoup,
                    bool isInsideOut) {
    SeparatedSoup separated;
    separated.pieces = static_cast<std::size_t>(std::count(isSoup.begin(), isSoup.end(), 1));
    if (separated.pieces == 0) return separated;
    separated.soup.points = mesh.points;
    std::vector<std::uint32_t> renumbered(pieces.size(), 0);
    std::uint32_t kept = 0;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        renumbered[c] = kept;
        if (isSoup[c] == 0) ++kept;
    }
    MeshComponents rest = components;
    rest.count = kept;
    rest.ofTriangle.clear();
    rest.boundary.clear();
    std::vector<Vec3I> solid;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t c = components.ofTriangle[i];
        Vec3I t = mesh.triangles[i];
        if (isSoup[c] == 0) {
            solid.push_back(t);
            rest.ofTriangle.push_back(renumbered[c]);
        } else if (i < firstCap) {
            if (pieces[c].isRound() ? pieces[c].volume < 0 : isInsideOut) std::swap(t[1], t[2]);
            separated.soup.triangles.push_back(t);
        }
    }
    mesh.triangles = std::move(solid);
    removeUnusedPoints(mesh);
    removeUnusedPoints(separated.soup);
    components = std::move(rest);
    separated.isSoup = std::move(isSoup);
    return separated;
}

}  // namespace

SeparatedSoup separateSoup(Mesh& mesh, MeshComponents& components, std::size_t firstCap) {
    if (firstCap == mesh.triangles.size()) return {};
    std::vector<OpenPiece> pieces = measure(mesh, components, firstCap);
    double area = 0, capArea = 0;
    for (const OpenPiece& piece : pieces) {
        area += piece.area;
        capArea += piece.capArea;
    }
    if (capArea < kLeastCaps * area) return {};
    // Turn flat pieces first, whose own shape does not tell what is outside.
    std::size_t flipped = 0;
    std::vector<char> isFlat(pieces.size(), 0);
    double flatArea = 0;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        if (pieces[c].caps.empty() || pieces[c].isRound()) continue;
        isFlat[c] = 1;
        flatArea += pieces[c].area;
    }
    if (flatArea > kLeastCaps * area) {
        flipped = orientByRays(mesh, components.ofTriangle, isFlat, firstCap);
        if (flipped > 0) pieces = measure(mesh, components, firstCap);
    }
    const CapJudge caps(mesh, firstCap);
    SeparatedSoup separated =
        split(mesh, components, firstCap, pieces, judge(pieces, caps), caps.isInsideOut());
    separated.trianglesFlipped = flipped;
    return separated;
}

SeparatedSoup separateAll(Mesh& mesh, MeshComponents& components, std::size_t firstCap) {
    return split(mesh, components, firstCap, measure(mesh, components, firstCap),
                 std::vector<char>(components.count, 1), facesInward(mesh, firstCap));
}

}  // namespace bandvox

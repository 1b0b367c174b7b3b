#include "source/separate_soup.h"

#include "source/mesh_bounds.h"
#include "source/orient_by_rays.h"
#include "source/turn_outward.h"
#include "source/weld_points.h"

#include <bandvox/source/winding_number.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

// A piece may be soup by itself if its caps are this large beside its own area; others, whose caps
// are this large, if soup lies where their caps are. Pieces of less than this part of the mesh's
// area altogether are not looked at.
constexpr double kLargeCaps = 0.4;
constexpr double kLeastCaps = 0.02;
constexpr double kLeastArea = 1e-4;

// So many caps of a piece, the largest, and so many pieces are looked at.
constexpr std::size_t kCapsOfPiece = 8;
constexpr std::size_t kMostPieces = 1000;

// How often it is looked again which of them are soup, the others being capped.
constexpr int kRoundsOfJudging = 3;

// The winding number is clear if it is this far from 0.5.
constexpr double kClearWinding = 0.25;

// A piece is soup if this part of its caps' area is wrong.
constexpr double kMostWrong = 0.25;
constexpr double kMostWrongOfFlat = 0.05;  // of the flat pieces' area

// A piece whose volume, relative to its area, is at least this tells what its outside is.
constexpr double kRound = 0.02;

// Sides of a cap are looked at this far from it, relative to its own size and to the mesh's.
constexpr double kAsideOfCap = 0.1;
constexpr double kAsideOfMesh = 1e-3;

struct OpenPiece {
    double area = 0;    // without caps
    double volume = 0;  // caps included
    double capArea = 0;
    std::vector<std::uint32_t> allCaps;
    std::vector<std::uint32_t> caps;  // the largest of them first

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
        if (i >= firstCap) piece.allCaps.push_back(i);
    }
    for (OpenPiece& piece : pieces) {
        piece.caps = piece.allCaps;
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

// Those of the caps whose pieces are wanted, as a mesh.
Mesh capsOf(const Mesh& mesh, const std::vector<std::uint32_t>& pieceOf, std::size_t firstCap,
            const std::vector<char>& isWanted) {
    Mesh result;
    result.points = mesh.points;
    for (std::size_t i = firstCap; i < mesh.triangles.size(); ++i) {
        if (isWanted[pieceOf[i]] != 0) result.triangles.push_back(mesh.triangles[i]);
    }
    removeUnusedPoints(result);
    return result;
}

// Compares what a piece's caps say with what the surface without them does, while only those of
// some others are missing as well. Caps far away that are right thus do not count: thousands of
// them add up to something.
class CapJudge {
  public:
    CapJudge(const Mesh& mesh, const std::vector<std::uint32_t>& pieceOf, std::size_t firstCap,
             std::size_t pieceCount)
        : mMesh(mesh),
          mPieceOf(pieceOf),
          mFirstCap(firstCap),
          mClosed(mesh),
          mAside(kAsideOfMesh * boundsOf(mesh).extents().length()) {
        setOpen(std::vector<char>(pieceCount, 0));
    }

    // Leaves the caps of these pieces out.
    void setOpen(std::vector<char> isOpen) {
        mIsOpen = std::move(isOpen);
        mOpenCaps.emplace(capsOf(mMesh, mPieceOf, mFirstCap, mIsOpen));
    }

    bool isWrong(const OpenPiece& piece, std::uint32_t number) const {
        std::optional<WindingNumber> own;
        if (mIsOpen[number] == 0) {
            own.emplace(capsOfPiece(piece));
        }
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
            if (isWrongAt(middle + aside, own) || isWrongAt(middle - aside, own)) wrong += size;
        }
        return wrong > kMostWrong * all;
    }

  private:
    // With points of their own: of a large mesh only few are theirs.
    Mesh capsOfPiece(const OpenPiece& piece) const {
        Mesh caps;
        for (const std::uint32_t cap : piece.allCaps) {
            const auto first = static_cast<openvdb::Index32>(caps.points.size());
            for (int k = 0; k < 3; ++k) {
                caps.points.push_back(mMesh.points[mMesh.triangles[cap][k]]);
            }
            caps.triangles.emplace_back(first, first + 1, first + 2);
        }
        return caps;
    }

    // True if the place is clearly inside without the caps and outside with them, or the other way
    // round.
    bool isWrongAt(const Vec3d& place, const std::optional<WindingNumber>& own) const {
        const double closed = std::round(mClosed.at(place));
        const double open = closed - mOpenCaps->at(place) - (own ? own->at(place) : 0);
        if (std::abs(open - 0.5) < kClearWinding) return false;
        return (open > 0.5) != (closed > 0.5);
    }

    const Mesh& mMesh;
    const std::vector<std::uint32_t>& mPieceOf;
    std::size_t mFirstCap;
    WindingNumber mClosed;
    double mAside;
    std::vector<char> mIsOpen;
    std::optional<WindingNumber> mOpenCaps;
};

// The part, by area, of some pieces whose caps are wrong.
class Vote {
  public:
    void add(double area, bool isWrong) {
        mAll += area;
        if (isWrong) mWrong += area;
    }
    double wrongPart() const { return mAll > 0 ? mWrong / mAll : 0; }

  private:
    double mAll = 0, mWrong = 0;
};

// Of the pieces that may be soup those that are, the others being capped.
std::vector<char> judge(const std::vector<OpenPiece>& pieces, std::vector<char> mayBe,
                        CapJudge& caps) {
    for (int round = 0; round < kRoundsOfJudging; ++round) {
        std::vector<std::uint32_t> some;
        for (std::uint32_t c = 0; c < pieces.size(); ++c) {
            if (mayBe[c] != 0) some.push_back(c);
        }
        if (some.empty()) break;
        caps.setOpen(mayBe);
        const std::size_t step = (some.size() + kMostPieces - 1) / kMostPieces;
        std::vector<char> isSoup(pieces.size(), 0);
        // Flat pieces enclose nothing if they are capped: they are soup together, if a part of them
        // is.
        Vote ofFlat, ofRound;
        for (std::size_t i = 0; i < some.size(); i += step) {
            const OpenPiece& piece = pieces[some[i]];
            isSoup[some[i]] = caps.isWrong(piece, some[i]) ? 1 : 0;
            (piece.isRound() ? ofRound : ofFlat).add(piece.area, isSoup[some[i]] != 0);
        }
        for (const std::uint32_t c : some) {
            if (!pieces[c].isRound()) {
                isSoup[c] = ofFlat.wrongPart() > kMostWrongOfFlat ? 1 : 0;
            } else if (step > 1) {
                isSoup[c] = ofRound.wrongPart() > kMostWrong ? 1 : 0;
            }
        }
        if (isSoup == mayBe) break;
        mayBe = std::move(isSoup);
    }
    return mayBe;
}

// Adds pieces whose caps soup contradicts.
void addContradicted(const std::vector<OpenPiece>& pieces, CapJudge& caps,
                     std::vector<char>& isSoup) {
    if (std::count(isSoup.begin(), isSoup.end(), 1) == 0) return;
    for (int round = 0; round < kRoundsOfJudging; ++round) {
        caps.setOpen(isSoup);
        std::vector<char> more = isSoup;
        std::size_t lookedAt = 0;
        for (std::uint32_t c = 0; c < pieces.size() && lookedAt < kMostPieces; ++c) {
            const OpenPiece& piece = pieces[c];
            if (isSoup[c] != 0 || piece.capArea < kLeastCaps * piece.area) continue;
            ++lookedAt;
            if (caps.isWrong(piece, c)) more[c] = 1;
        }
        if (more == isSoup) break;
        isSoup = std::move(more);
    }
}

// Turns open pieces outward: round ones by what they enclose, flat ones as rays say. Returns how
// many triangles that were, without caps.
std::size_t turnOpenPieces(Mesh& mesh, const MeshComponents& components, std::size_t firstCap,
                           const std::vector<OpenPiece>& pieces) {
    std::vector<char> isFlat(pieces.size(), 0);
    std::size_t flipped = 0;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        isFlat[c] = !pieces[c].caps.empty() && !pieces[c].isRound() ? 1 : 0;
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const OpenPiece& piece = pieces[components.ofTriangle[i]];
        if (piece.caps.empty() || !piece.isRound() || piece.volume > 0) continue;
        std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
        if (i < firstCap) ++flipped;
    }
    return flipped + orientByRays(mesh, components.ofTriangle, isFlat, firstCap);
}

// Moves the pieces that are soup out of a mesh, leaving their caps away.
SeparatedSoup split(Mesh& mesh, MeshComponents& components, std::size_t firstCap,
                    std::vector<char> isSoup) {
    SeparatedSoup separated;
    separated.pieces = static_cast<std::size_t>(std::count(isSoup.begin(), isSoup.end(), 1));
    if (separated.pieces == 0) return separated;
    separated.soup.points = mesh.points;
    std::vector<std::uint32_t> renumbered(isSoup.size(), 0);
    std::uint32_t kept = 0;
    for (std::size_t c = 0; c < isSoup.size(); ++c) {
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
        const Vec3I& t = mesh.triangles[i];
        if (isSoup[c] == 0) {
            solid.push_back(t);
            rest.ofTriangle.push_back(renumbered[c]);
        } else if (i < firstCap) {
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
    const std::vector<OpenPiece> pieces = measure(mesh, components, firstCap);
    std::vector<char> mayBe(pieces.size(), 0);
    double area = 0, areaOfThese = 0;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        area += pieces[c].area;
        if (pieces[c].capArea < kLargeCaps * pieces[c].area || pieces[c].caps.empty()) continue;
        mayBe[c] = 1;
        areaOfThese += pieces[c].area;
    }
    if (areaOfThese <= kLeastArea * area) return {};
    const std::size_t flipped = turnOpenPieces(mesh, components, firstCap, pieces);
    CapJudge caps(mesh, components.ofTriangle, firstCap, pieces.size());
    std::vector<char> isSoup = judge(pieces, std::move(mayBe), caps);
    addContradicted(pieces, caps, isSoup);
    std::size_t sheets = 0;
    for (std::size_t c = 0; c < pieces.size(); ++c) {
        const OpenPiece& piece = pieces[c];
        const bool isSheet = piece.capArea >= kLargeCaps * piece.area && !piece.isRound();
        if (isSoup[c] == 0 && !piece.caps.empty() && isSheet) ++sheets;
    }
    SeparatedSoup separated = split(mesh, components, firstCap, std::move(isSoup));
    separated.sheets = sheets;
    separated.trianglesFlipped = flipped;
    return separated;
}

SeparatedSoup separateAll(Mesh& mesh, MeshComponents& components, std::size_t firstCap) {
    // Closed pieces first, of which cavities stay what they are.
    turnOutward(mesh, components);
    const std::size_t flipped =
        turnOpenPieces(mesh, components, firstCap, measure(mesh, components, firstCap));
    SeparatedSoup separated =
        split(mesh, components, firstCap, std::vector<char>(components.count, 1));
    separated.trianglesFlipped = flipped;
    return separated;
}

}  // namespace bandvox

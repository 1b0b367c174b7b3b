#include "compare/farthest_point.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {

namespace {

using openvdb::Vec3d;

constexpr std::size_t kPiecesPerTask = 1024;

// A part of a triangle. Of the other mesh it knows the nearest points of four places.
struct SurfacePiece {
    std::array<PlaceDistance, 3> corners;
    PlaceDistance middle;
    double atMost = 0;  // no place of it is farther
};

Vec3d middleOf(const std::array<PlaceDistance, 3>& corners) {
    return (corners[0].place + corners[1].place + corners[2].place) / 3.0;
}

// No place is farther from a mesh than a place beside it, and the way there.
double boundByWay(const SurfacePiece& piece) {
    double way = 0;
    for (const PlaceDistance& corner : piece.corners) {
        way = std::max(way, (corner.place - piece.middle.place).length());
    }
    return piece.middle.distance + way;
}

// The distance from a triangle is convex, so that it is the largest at a corner of the piece.
double boundByTriangle(const SurfacePiece& piece, const Mesh& other, std::uint32_t triangle) {
    const TriangleCorners corners = cornersOf(other, triangle);
    double largest = 0;
    for (const PlaceDistance& corner : piece.corners) {
        largest = std::max(largest, nearestOnTriangle(corner.place, corners).square);
    }
    return std::sqrt(largest);
}

double boundOf(const SurfacePiece& piece, const Mesh& other) {
    double bound = boundByWay(piece);
    bound = std::min(bound, boundByTriangle(piece, other, piece.middle.triangle));
    for (const PlaceDistance& corner : piece.corners) {
        if (corner.triangle == piece.middle.triangle) continue;
        bound = std::min(bound, boundByTriangle(piece, other, corner.triangle));
    }
    // What was found there counts, however it rounds.
    for (const PlaceDistance& corner : piece.corners) bound = std::max(bound, corner.distance);
    return std::max(bound, piece.middle.distance);
}

// Four pieces of a piece, cut at the middles of its sides. The one inside has the same middle.
std::array<SurfacePiece, 4> quartered(const SurfacePiece& piece, const TriangleTree& other) {
    const auto look = [&](const Vec3d& place) {
        return placeDistance(other, place, piece.middle.triangle);
    };
    std::array<PlaceDistance, 3> sides;
    for (std::size_t k = 0; k < 3; ++k) {
        sides[k] = look((piece.corners[k].place + piece.corners[(k + 1) % 3].place) / 2.0);
    }
    std::array<SurfacePiece, 4> parts;
    for (std::size_t k = 0; k < 3; ++k) {
        parts[k].corners = {piece.corners[k], sides[k], sides[(k + 2) % 3]};
        parts[k].middle = look(middleOf(parts[k].corners));
    }
    parts[3].corners = sides;
    parts[3].middle = piece.middle;
    for (SurfacePiece& part : parts) {
        part.atMost = std::min(boundOf(part, other.mesh()), piece.atMost);
    }
    return parts;
}

// The farthest place so far, in order, so that the same one is found again.
void noteFarthest(const PlaceDistance& p, FarthestPoint& farthest) {
    if (!(p.distance > farthest.distance)) return;
    farthest.distance = p.distance;
    farthest.at = p;
}

// Calls body(i) for each i < count, many at a time.
template <typename Body>
void inParts(std::size_t count, Progress& progress, const Body& body) {
    const std::size_t tasks = (count + kPiecesPerTask - 1) / kPiecesPerTask;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kPiecesPerTask;
        for (std::size_t i = begin; i < std::min(begin + kPiecesPerTask, count); ++i) body(i);
    });
}

class FarthestFinder {
  public:
    FarthestFinder(const TriangleTree& other, const FarthestSearch& search, Progress& progress)
        : mOther(other), mSearch(search), mProgress(progress) {}

    // Takes triangles as the first pieces.
    void start(const Mesh& mesh, const std::vector<PlaceDistance>& corners,
               const std::vector<PlaceDistance>& middles) {
        const std::size_t count = mesh.triangles.size();
        const auto pieceAt = [&](std::size_t i) {
            SurfacePiece piece;
            const openvdb::Vec3I& t = mesh.triangles[i];
            piece.corners = {corners[t[0]], corners[t[1]], corners[t[2]]};
            piece.middle = middles[i];
            return piece;
        };
        std::vector<double> bounds(count);
        inParts(count, mProgress,
                [&](std::size_t i) { bounds[i] = boundOf(pieceAt(i), mOther.mesh()); });
        for (std::size_t i = 0; i < count; ++i) {
            const SurfacePiece piece = pieceAt(i);
            for (const PlaceDistance& corner : piece.corners) noteFarthest(corner, mFarthest);
            noteFarthest(piece.middle, mFarthest);
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (settles(bounds[i])) continue;
            mPieces.push_back(pieceAt(i));
            mPieces.back().atMost = bounds[i];
        }
        mLeft = mSearch.mostPieces;
    }

    FarthestPoint finish() {
        while (!mPieces.empty() && mLeft >= kParts) cutOnce();
        for (const SurfacePiece& piece : mPieces) mProven = std::max(mProven, piece.atMost);
        mFarthest.atMost = std::max(mFarthest.distance, mProven);
        return mFarthest;
    }

  private:
    static constexpr std::size_t kParts = 4;
    static constexpr std::size_t kMostAtATime = std::size_t(1) << 18;

    // Whether a piece need not be looked at more closely.
    bool settles(double bound) {
        if (bound > mFarthest.distance + mSearch.tolerance) return false;
        mProven = std::max(mProven, bound);
        return true;
    }

    // Cuts the pieces that may reach farthest.
    void cutOnce() {
        const std::size_t count = std::min({mPieces.size(), mLeft / kParts, kMostAtATime});
        const std::size_t first = mPieces.size() - count;
        std::nth_element(
            mPieces.begin(), mPieces.begin() + static_cast<std::ptrdiff_t>(first), mPieces.end(),
            [](const SurfacePiece& a, const SurfacePiece& b) { return a.atMost < b.atMost; });
        std::vector<std::array<SurfacePiece, 4>> parts(count);
        inParts(count, mProgress,
                [&](std::size_t i) { parts[i] = quartered(mPieces[first + i], mOther); });
        mPieces.resize(first);
        mLeft -= kParts * count;
        for (const auto& four : parts) {
            for (const PlaceDistance& side : four[3].corners) noteFarthest(side, mFarthest);
            for (const SurfacePiece& part : four) noteFarthest(part.middle, mFarthest);
        }
        std::erase_if(mPieces, [this](const SurfacePiece& p) { return settles(p.atMost); });
        for (const auto& four : parts) {
            for (const SurfacePiece& part : four) {
                if (!settles(part.atMost)) mPieces.push_back(part);
            }
        }
    }

    const TriangleTree& mOther;
    FarthestSearch mSearch;
    Progress& mProgress;
    FarthestPoint mFarthest;
    double mProven = 0;  // of the pieces that are settled
    std::vector<SurfacePiece> mPieces;
    std::size_t mLeft = 0;  // pieces that may still be made
};

}  // namespace

PlaceDistance placeDistance(const TriangleTree& other, const Vec3d& place, std::uint32_t hint) {
    const NearestOnMesh nearest = other.nearest(place, hint);
    return {place, std::sqrt(nearest.square), nearest.triangle};
}

FarthestPoint findFarthest(const Mesh& mesh, const TriangleTree& other,
                           const std::vector<PlaceDistance>& corners,
                           const std::vector<PlaceDistance>& middles, const FarthestSearch& search,
                           Progress& progress) {
    FarthestFinder finder(other, search, progress);
    finder.start(mesh, corners, middles);
    return finder.finish();
}

}  // namespace bandvox

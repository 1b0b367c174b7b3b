#include "source/orient_by_rays.h"

#include "source/box_tree.h"
#include "source/ray_crossing.h"

#include <bandvox/core/parallel.h>

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace bandvox {

namespace {

using openvdb::Mat3d;
using openvdb::Vec3d;
using openvdb::Vec3I;

constexpr int kRayDirections = 8;
constexpr std::size_t kTrianglesOfPiece = 4;  // that rays start from, the largest

// So many pieces are asked first, and all only if more than this part of those look the wrong way.
constexpr std::size_t kSample = 200;
constexpr double kFewWrong = 0.03;

// Rays that leave a triangle at less than this, a cosine, are not looked at.
constexpr double kLeastSlope = 0.1;

// Rotations that turn directions spread at random into the x axis, the same every time.
std::vector<Mat3d> rotations() {
    std::mt19937 random(20);
    std::normal_distribution<> normal;
    const auto direction = [&] {
        Vec3d d(normal(random), normal(random), normal(random));
        d.normalize();
        return d;
    };
    std::vector<Mat3d> found;
    for (int i = 0; i < kRayDirections; ++i) {
        const Vec3d x = direction();
        Vec3d y = x.cross(direction());
        y.normalize();
        found.emplace_back(x, y, x.cross(y), true);
    }
    return found;
}

// The mesh seen along one direction, which is its x.
class View {
  public:
    View(const Mesh& mesh, std::size_t own, const Mat3d& rotation)
        : mMesh(mesh), mPoints(rotated(mesh.points, rotation)), mTree(boxes(own)) {}

    // Positive if the triangle looks outward by the rays from both of its sides, negative if
    // inward, 0 if they contradict each other.
    double vote(std::uint32_t triangle) const {
        const std::array<Vec3d, 3> corner = corners(triangle);
        Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        if (!(normal.length() > 0)) return 0;
        normal.normalize();
        if (std::abs(normal.x()) < kLeastSlope) return 0;
        const Vec3d middle = (corner[0] + corner[1] + corner[2]) / 3.0;
        int ahead = 0, behind = 0;
        const Vec3d start(std::numeric_limits<double>::lowest(), middle.y(), middle.z());
        mTree.visitAlongX(start, [&](std::uint32_t other) {
            if (other == triangle) return;
            const auto crossing = lineCrossing(middle.y(), middle.z(), corners(other));
            if (crossing) ++(crossing->x > middle.x() ? ahead : behind);
        });
        if ((ahead + behind) % 2 == 0) return 0;
        // With one of them odd, that is the inside.
        const bool looksAhead = normal.x() > 0;
        const bool isInsideAhead = ahead % 2 == 1;
        return (looksAhead != isInsideAhead ? 1 : -1) * std::abs(normal.x());
    }

  private:
    static std::vector<Vec3d> rotated(std::vector<Vec3d> points, const Mat3d& rotation) {
        for (Vec3d& p : points) p = rotation * p;
        return points;
    }
    std::array<Vec3d, 3> corners(std::uint32_t i) const {
        const Vec3I& t = mMesh.triangles[i];
        return {mPoints[t[0]], mPoints[t[1]], mPoints[t[2]]};
    }
    std::vector<openvdb::BBoxd> boxes(std::size_t count) const {
        std::vector<openvdb::BBoxd> found(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            for (const Vec3d& c : corners(i)) found[i].expand(c);
        }
        return found;
    }

    const Mesh& mMesh;
    std::vector<Vec3d> mPoints;
    BoxTree mTree;
};

// The largest triangles of each piece that is wanted.
std::vector<std::vector<std::uint32_t>> largestTriangles(const Mesh& mesh,
                                                         const std::vector<std::uint32_t>& pieceOf,
                                                         const std::vector<char>& isWanted,
                                                         std::size_t own) {
    std::vector<std::vector<std::pair<double, std::uint32_t>>> bySize(isWanted.size());
    for (std::uint32_t i = 0; i < own; ++i) {
        if (isWanted[pieceOf[i]] == 0) continue;
        const Vec3I& t = mesh.triangles[i];
        const Vec3d& a = mesh.points[t[0]];
        const double size = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).lengthSqr();
        bySize[pieceOf[i]].emplace_back(-size, i);
    }
    std::vector<std::vector<std::uint32_t>> largest(isWanted.size());
    for (std::size_t piece = 0; piece < bySize.size(); ++piece) {
        auto& triangles = bySize[piece];
        const std::size_t count = std::min(triangles.size(), kTrianglesOfPiece);
        std::partial_sort(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(count),
                          triangles.end());
        for (std::size_t k = 0; k < count; ++k) largest[piece].push_back(triangles[k].second);
    }
    return largest;
}

// The sum of each piece's votes from all directions, by the triangles given of it.
std::vector<double> votesOf(const Mesh& mesh, std::size_t own,
                            const std::vector<std::vector<std::uint32_t>>& triangles) {
    const std::vector<Mat3d> all = rotations();
    std::vector<std::vector<double>> votes(all.size());
    parallelFor(std::ssize(all), [&](std::int64_t i) {
        const View view(mesh, own, all[i]);
        votes[i].assign(triangles.size(), 0);
        for (std::size_t piece = 0; piece < triangles.size(); ++piece) {
            for (const std::uint32_t triangle : triangles[piece]) {
                votes[i][piece] += view.vote(triangle);
            }
        }
    });
    std::vector<double> sum(triangles.size(), 0);
    for (const std::vector<double>& v : votes) {
        for (std::size_t piece = 0; piece < sum.size(); ++piece) sum[piece] += v[piece];
    }
    return sum;
}

// Some of the pieces, evenly spread.
std::vector<std::vector<std::uint32_t>> sampleOf(
    const std::vector<std::vector<std::uint32_t>>& triangles) {
    std::vector<std::size_t> wanted;
    for (std::size_t piece = 0; piece < triangles.size(); ++piece) {
        if (!triangles[piece].empty()) wanted.push_back(piece);
    }
    std::vector<std::vector<std::uint32_t>> sample(triangles.size());
    const std::size_t step = (wanted.size() + kSample - 1) / kSample;
    for (std::size_t i = 0; i < wanted.size(); i += step) {
        sample[wanted[i]] = triangles[wanted[i]];
    }
    return sample;
}

}  // namespace

std::size_t orientByRays(Mesh& mesh, const std::vector<std::uint32_t>& pieceOf,
                         const std::vector<char>& isWanted, std::size_t own) {
    const auto largest = largestTriangles(mesh, pieceOf, isWanted, own);
    const auto isNegative = [](double vote) { return vote < 0; };
    std::vector<double> votes = votesOf(mesh, own, sampleOf(largest));
    // If hardly any of the sample looks the wrong way, rays that went through openings say so.
    const auto wrong = std::count_if(votes.begin(), votes.end(), isNegative);
    const auto right = std::count_if(votes.begin(), votes.end(), [](double v) { return v > 0; });
    if (static_cast<double>(wrong) <= kFewWrong * static_cast<double>(wrong + right)) return 0;
    votes = votesOf(mesh, own, largest);
    std::size_t flipped = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!isNegative(votes[pieceOf[i]])) continue;
        std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
        if (i < own) ++flipped;
    }
    return flipped;
}

}  // namespace bandvox

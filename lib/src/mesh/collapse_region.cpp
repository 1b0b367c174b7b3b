#include "mesh/collapse_region.h"

#include "source/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// A triangle's normal and those of its corners' mean differ by less than 60°.
constexpr double kLeastCosine = 0.5;

// Twice the area over the square of the longest side, which is 0.87 of the best triangles; worse
// ones than this are made only of ones that are no better.
constexpr double kLeastFatness = 0.15;

// By how much a length counts as if it were a displacement: so that short edges go first.
constexpr double kLengthCost = 0.02;

constexpr std::size_t kMostAttempts = 3;

double fatness(const std::array<Vec3d, 3>& triangle) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
        longest = std::max(longest, (triangle[(k + 1) % 3] - triangle[k]).lengthSqr());
    }
    const double area = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).length();
    return longest > 0 ? area / longest : 0;
}

double distanceToAny(const Vec3d& place, const std::vector<std::array<Vec3d, 3>>& triangles) {
    double nearest = std::numeric_limits<double>::max();
    for (const auto& triangle : triangles) {
        nearest = std::min(nearest, distanceToTriangle(place, triangle));
    }
    return nearest;
}

// The distance between two segments along the normal of both, where they cross as seen along it; 0
// if they do not.
double distanceWhereCrossing(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    const Vec3d first = b - a, second = d - c;
    const Vec3d across = first.cross(second);
    const double square = across.lengthSqr();
    if (!(square > 0)) return 0;
    const double s = (c - a).cross(second).dot(across) / square;
    const double t = (c - a).cross(first).dot(across) / square;
    if (s < 0 || s > 1 || t < 0 || t > 1) return 0;
    return std::abs((c - a).dot(across)) / std::sqrt(square);
}

}  // namespace

CollapseRegion::CollapseRegion(CollapsingMesh& mesh, std::span<const std::uint32_t> triangles,
                               double tolerance)
    : mMesh(mesh), mTolerance(tolerance) {
    constexpr std::uint32_t kNone = ~0U;
    for (const std::uint32_t t : triangles) {
        for (int k = 0; k < 3; ++k) mMesh.local[mMesh.surface.mesh.triangles[t][k]] = kNone;
    }
    for (const std::uint32_t t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t point = mMesh.surface.mesh.triangles[t][k];
            std::uint32_t& local = mMesh.local[point];
            if (local == kNone) {
                local = static_cast<std::uint32_t>(mPoints.size());
                mPoints.push_back(point);
                mTriangles.emplace_back();
            }
            mTriangles[local].push_back(t);
        }
    }
    mChanges.resize(mPoints.size(), 0);
    mIsFree.resize(mPoints.size());
    for (std::uint32_t p = 0; p < mPoints.size(); ++p) {
        mIsFree[p] = mTriangles[p].size() == mMesh.degree[mPoints[p]];
    }
}

const Vec3d& CollapseRegion::place(std::uint32_t point) const {
    return mMesh.surface.mesh.points[mPoints[point]];
}

std::uint32_t CollapseRegion::corner(std::uint32_t triangle, int k) const {
    return mMesh.local[mMesh.surface.mesh.triangles[triangle][k % 3]];
}

bool CollapseRegion::isFree(std::uint32_t point) const {
    return mIsFree[point] && !mTriangles[point].empty();
}

void CollapseRegion::findNeighbours(std::uint32_t point, std::vector<std::uint32_t>& found) const {
    found.clear();
    for (const std::uint32_t t : mTriangles[point]) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = corner(t, k);
            if (other != point) found.push_back(other);
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

// Finds what is around a point; returns how far that may be from the surface.
float CollapseRegion::lookAround(std::uint32_t point) {
    mNormals.clear();
    float error = 0;
    for (const std::uint32_t t : mTriangles[point]) {
        error = std::max(error, mMesh.error[t]);
        const Vec3d& a = place(corner(t, 0));
        const Vec3d normal = (place(corner(t, 1)) - a).cross(place(corner(t, 2)) - a);
        const double length = normal.length();
        if (length > 0) mNormals.push_back(normal / length);
    }
    findNeighbours(point, mAround);
    return error;
}

// How far the neighbour is from the planes of the triangles around the point, whose normals are in
// mNormals.
double CollapseRegion::moveCost(std::uint32_t point, std::uint32_t onto) const {
    const Vec3d move = place(onto) - place(point);
    double farthest = 0;
    for (const Vec3d& normal : mNormals) farthest = std::max(farthest, std::abs(normal.dot(move)));
    return farthest + kLengthCost * move.length();
}

void CollapseRegion::propose(std::uint32_t point) {
    if (!isFree(point)) return;
    ++mChanges[point];
    const float error = lookAround(point);
    double least = std::numeric_limits<double>::max();
    for (const std::uint32_t onto : mAround) {
        if (isFree(onto)) least = std::min(least, moveCost(point, onto));
    }
    if (least < std::numeric_limits<double>::max()) {
        mQueue.push({error + least, point, mChanges[point]});
    }
}

std::size_t CollapseRegion::collapse() {
    for (std::uint32_t p = 0; p < mPoints.size(); ++p) propose(p);
    std::size_t count = 0;
    while (!mQueue.empty()) {
        const Candidate next = mQueue.top();
        mQueue.pop();
        if (next.change == mChanges[next.point] && tryCollapse(next.point)) ++count;
    }
    return count;
}

bool CollapseRegion::tryCollapse(std::uint32_t point) {
    const float error = lookAround(point);
    std::vector<std::pair<double, std::uint32_t>> targets;
    for (const std::uint32_t onto : mAround) {
        if (isFree(onto)) targets.emplace_back(moveCost(point, onto), onto);
    }
    const std::size_t attempts = std::min(targets.size(), kMostAttempts);
    std::partial_sort(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(attempts),
                      targets.end());
    const double limit = mTolerance - error;
    for (std::size_t i = 0; i < attempts; ++i) {
        const std::uint32_t onto = targets[i].second;
        if (!keepsManifold(point, onto) || !keepsShape(point, onto)) continue;
        const double moved = displacement(point, onto, limit);
        if (moved > limit) continue;
        apply(point, onto, error + static_cast<float>(moved));
        return true;
    }
    return false;
}

// An edge can go if its ends have no neighbours in common but the two across from it.
bool CollapseRegion::keepsManifold(std::uint32_t point, std::uint32_t onto) {
    findNeighbours(onto, mBeyond);
    std::size_t common = 0;
    for (const std::uint32_t other : mAround) {
        if (std::binary_search(mBeyond.begin(), mBeyond.end(), other)) ++common;
    }
    // Of a tetrahedron two triangles would be left.
    return common == 2 && !(mTriangles[point].size() == 3 && mBeyond.size() == 3);
}

// Gathers the triangles around the point before and after, and looks at those.
bool CollapseRegion::keepsShape(std::uint32_t point, std::uint32_t onto) {
    mOld.clear();
    mNew.clear();
    double thinnest = kLeastFatness;
    for (const std::uint32_t t : mTriangles[point]) {
        auto& before = mOld.emplace_back();
        auto after = before;
        Vec3d direction(0.0);
        bool isGone = false;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t old = corner(t, k);
            isGone = isGone || old == onto;
            const std::uint32_t now = old == point ? onto : old;
            before[k] = place(old);
            after[k] = place(now);
            direction += Vec3d(mMesh.surface.normals[mPoints[now]]);
        }
        thinnest = std::min(thinnest, fatness(before));
        if (isGone) continue;
        mNew.push_back(after);
        const Vec3d normal = (after[1] - after[0]).cross(after[2] - after[0]);
        if (!(normal.dot(direction) > kLeastCosine * normal.length() * direction.length())) {
            return false;
        }
    }
    return std::all_of(mNew.begin(), mNew.end(),
                       [&](const auto& triangle) { return fatness(triangle) > thinnest; });
}

// How far apart the triangles around a point before and after are. Seen along their normals they
// are flat pieces between the point and the places where edges of the one cross edges of the other,
// so they are farthest apart at one of those.
double CollapseRegion::displacement(std::uint32_t point, std::uint32_t onto, double limit) {
    double farthest = distanceToAny(place(point), mNew);
    for (const std::uint32_t beyond : mAround) {
        if (farthest > limit) break;
        const bool isNew =
            beyond != onto && !std::binary_search(mBeyond.begin(), mBeyond.end(), beyond);
        if (!isNew) continue;
        for (const std::uint32_t other : mAround) {
            if (other == onto || other == beyond) continue;
            farthest = std::max(farthest, distanceWhereCrossing(place(onto), place(beyond),
                                                                place(point), place(other)));
        }
    }
    return farthest;
}

void CollapseRegion::apply(std::uint32_t point, std::uint32_t onto, float error) {
    for (const std::uint32_t t : mTriangles[point]) {
        openvdb::Vec3I& corners = mMesh.surface.mesh.triangles[t];
        const bool isGone = corner(t, 0) == onto || corner(t, 1) == onto || corner(t, 2) == onto;
        if (isGone) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t other = corner(t, k);
                if (other != point) std::erase(mTriangles[other], t);
            }
            mMesh.error[t] = -1;
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            if (corner(t, k) == point) corners[k] = mPoints[onto];
        }
        mMesh.error[t] = error;
        mTriangles[onto].push_back(t);
    }
    mTriangles[point].clear();
    ++mChanges[point];
    const std::vector<std::uint32_t> around = mAround;
    for (const std::uint32_t other : around) propose(other);
}

}  // namespace bandvox

#include "triangle_voxels.h"

#include <openvdb/math/BBox.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox::experiments {

namespace {

using openvdb::Coord;
using openvdb::Vec3d;

// True if the triangle and the cube of side 1 about the origin have no plane between them: of the
// cube's three directions, the triangle's normal, and the nine of their edges' products.
bool meetsCube(const std::array<Vec3d, 3>& corner) {
    constexpr double kHalf = 0.5;
    const auto isApart = [&](const Vec3d& axis) {
        const double a = axis.dot(corner[0]), b = axis.dot(corner[1]), c = axis.dot(corner[2]);
        const double reach = kHalf * (std::abs(axis.x()) + std::abs(axis.y()) + std::abs(axis.z()));
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    for (int i = 0; i < 3; ++i) {
        Vec3d axis(0.0);
        axis[i] = 1;
        if (isApart(axis)) return false;
    }
    const std::array<Vec3d, 3> edge = {corner[1] - corner[0], corner[2] - corner[1],
                                       corner[0] - corner[2]};
    if (isApart(edge[0].cross(edge[1]))) return false;
    for (int i = 0; i < 3; ++i) {
        Vec3d axis(0.0);
        axis[i] = 1;
        for (const Vec3d& e : edge) {
            if (isApart(axis.cross(e))) return false;
        }
    }
    return true;
}

}  // namespace

TriangleVoxels::TriangleVoxels(const Mesh& mesh, double voxelSize) {
    openvdb::BBoxd box;
    for (const Vec3d& p : mesh.points) box.expand(p / voxelSize);
    for (int axis = 0; axis < 3; ++axis) {
        mFirst[axis] = static_cast<int>(std::floor(box.min()[axis])) - 1;
        mCount[axis] = static_cast<int>(std::ceil(box.max()[axis])) + 2 - mFirst[axis];
    }
    mState.assign(static_cast<std::size_t>(mCount.x()) * mCount.y() * mCount.z(), kUnknown);
    markBoundary(mesh, voxelSize);
    floodOutside();
    const auto outside = std::count(mState.begin(), mState.end(), kOutside);
    mBoundary = std::count(mState.begin(), mState.end(), kBoundary);
    mInside = static_cast<std::int64_t>(mState.size()) - outside;
}

// Step (1) of the paper.
void TriangleVoxels::markBoundary(const Mesh& mesh, double voxelSize) {
    for (const openvdb::Vec3I& t : mesh.triangles) {
        std::array<Vec3d, 3> corner;
        Coord low, high;
        for (int k = 0; k < 3; ++k) {
            corner[k] = mesh.points[t[k]] / voxelSize - mFirst.asVec3d();
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double a = corner[0][axis], b = corner[1][axis], c = corner[2][axis];
            low[axis] = static_cast<int>(std::ceil(std::min({a, b, c}) - 0.5));
            high[axis] = static_cast<int>(std::floor(std::max({a, b, c}) + 0.5));
        }
        Coord voxel;
        for (voxel.x() = low.x(); voxel.x() <= high.x(); ++voxel.x()) {
            for (voxel.y() = low.y(); voxel.y() <= high.y(); ++voxel.y()) {
                for (voxel.z() = low.z(); voxel.z() <= high.z(); ++voxel.z()) {
                    std::uint8_t& state = mState[index(voxel)];
                    if (state == kBoundary) continue;
                    const Vec3d center = voxel.asVec3d();
                    if (meetsCube({corner[0] - center, corner[1] - center, corner[2] - center})) {
                        state = kBoundary;
                    }
                }
            }
        }
    }
}

// Step (2): what is not reached from outside is inside.
void TriangleVoxels::floodOutside() {
    std::vector<Coord> pending{Coord(0)};
    mState[0] = kOutside;
    while (!pending.empty()) {
        const Coord voxel = pending.back();
        pending.pop_back();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                Coord next = voxel;
                next[axis] += step;
                if (next[axis] < 0 || next[axis] >= mCount[axis]) continue;
                std::uint8_t& state = mState[index(next)];
                if (state != kUnknown) continue;
                state = kOutside;
                pending.push_back(next);
            }
        }
    }
}

}  // namespace bandvox::experiments

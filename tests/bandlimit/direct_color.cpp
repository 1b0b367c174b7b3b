#include "bandlimit/direct_color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {

using openvdb::Vec3d;
using std::numbers::pi;

DirectColor::DirectColor(const Mesh& mesh, double voxelSize, double cutoff, double spacing,
                         const Paint& paint)
    : mCutoff(cutoff), mSpacing(spacing) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const openvdb::Vec3I& t = mesh.triangles[i];
        add(i,
            {mesh.points[t[0]] / voxelSize, mesh.points[t[1]] / voxelSize,
             mesh.points[t[2]] / voxelSize},
            {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, paint);
    }
}

// Halves the longest edge until it is short, then takes the middle.
void DirectColor::add(std::size_t triangle, const std::array<Vec3d, 3>& corner,
                      const std::array<Vec3d, 3>& weights, const Paint& paint) {
    int longest = 0;
    double length = -1;
    for (int i = 0; i < 3; ++i) {
        const double edge = (corner[(i + 1) % 3] - corner[(i + 2) % 3]).length();
        if (edge > length) {
            length = edge;
            longest = i;
        }
    }
    if (length <= mSpacing) {
        const Vec3d middle = (weights[0] + weights[1] + weights[2]) / 3;
        const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).length();
        mPoints.push_back({(corner[0] + corner[1] + corner[2]) / 3, paint(triangle, middle), area});
        return;
    }
    const int a = longest, b = (longest + 1) % 3, c = (longest + 2) % 3;
    const Vec3d place = 0.5 * (corner[b] + corner[c]);
    const Vec3d weight = 0.5 * (weights[b] + weights[c]);
    add(triangle, {corner[a], corner[b], place}, {weights[a], weights[b], weight}, paint);
    add(triangle, {corner[a], place, corner[c]}, {weights[a], weight, weights[c]}, paint);
}

// exp(-(|k| / k_c)²) is the transform of  h(r) = π^{3/2} k_c³ exp(-(π k_c r)²).
DirectColor::Sums DirectColor::sums(const openvdb::Coord& voxel) const {
    const Vec3d at = voxel.asVec3d();
    const double scale = std::pow(pi * mCutoff, 2);
    Vec3d color(0);
    double area = 0;
    for (const Point& point : mPoints) {
        const double squared = scale * (point.position - at).lengthSqr();
        if (squared > 40) continue;
        const double weight = point.area * std::exp(-squared);
        color += weight * point.color;
        area += weight;
    }
    const double h = std::pow(pi, 1.5) * std::pow(mCutoff, 3);
    return {color / area, h * area / (std::sqrt(pi) * mCutoff)};
}

double DirectColor::largestError(const openvdb::Vec3SGrid& grid, int stride,
                                 double leastShare) const {
    double largest = 0;
    int i = 0;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        if (i++ % stride != 0) continue;
        const Sums truth = sums(value.getCoord());
        if (truth.share < leastShare) continue;
        const Vec3d difference = Vec3d(*value) - truth.color;
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(difference[k]));
    }
    return largest;
}

DirectColor::Paint cornerPaint(const ColoredMesh& mesh) {
    return [&mesh](std::size_t i, const Vec3d& weights) {
        Vec3d color(0);
        for (int k = 0; k < 3; ++k) color += weights[k] * Vec3d(mesh.paints[i].color[k]);
        return color;
    };
}

}  // namespace bandvox

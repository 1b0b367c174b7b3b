#include "source/compensated_sum.h"
#include "source/region_clip.h"

#include <bandvox/core/error.h>
#include <bandvox/source/mesh_source.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;

/// Halvings after which a triangle is taken as it is. Two of them halve its longest edge, so
/// this is enough for 2^32 voxels and ends the recursion on coordinates that make no sense.
constexpr int kDeepestTriangleSplit = 64;

/// What stays the same while a triangle is being split.
struct TriangleSampling {
    const SurfaceQuadrature& quadrature;
    RegionClip clip;
    std::vector<SurfaceSample>& samples;
};

/// The lowest rule that is accurate on a triangle with this longest edge, or kTriangleRules.
int lowestTriangleRule(const SurfaceQuadrature& quadrature, double edgeSquared) {
    int rule = 0;
    while (rule < kTriangleRules &&
           quadrature.triangleEdge[rule] * quadrature.triangleEdge[rule] < edgeSquared) {
        ++rule;
    }
    return rule;
}

void applyRule(int rule, const std::array<Vec3d, 3>& corner, const Vec3d& areaVector,
               const TriangleSampling& sampling) {
    const Vec3d e1 = corner[1] - corner[0];
    const Vec3d e2 = corner[2] - corner[0];
    for (const TrianglePoint& p : triangleRule(rule)) {
        sampling.clip.append(corner[0] + p.b * e1 + p.c * e2, p.weight * areaVector,
                             sampling.samples);
    }
}

void sampleTriangle(const std::array<Vec3d, 3>& corner, const Vec3d& areaVector, int depth,
                    const TriangleSampling& sampling) {
    // Find the longest edge; edge i lies opposite corner i.
    int longest = 0;
    double longestSquared = -1.0;
    for (int i = 0; i < 3; ++i) {
        const double squared = (corner[(i + 2) % 3] - corner[(i + 1) % 3]).lengthSqr();
        if (squared > longestSquared) {
            longestSquared = squared;
            longest = i;
        }
    }

    const int rule = lowestTriangleRule(sampling.quadrature, longestSquared);
    if (rule < kTriangleRules || depth == kDeepestTriangleSplit) {
        applyRule(std::min(rule, kTriangleRules - 1), corner, areaVector, sampling);
        return;
    }

    // Leave out what the region cannot see; this changes no point that it can.
    const Vec3d lower =
        openvdb::math::minComponent(corner[0], openvdb::math::minComponent(corner[1], corner[2]));
    const Vec3d upper =
        openvdb::math::maxComponent(corner[0], openvdb::math::maxComponent(corner[1], corner[2]));
    if (sampling.clip.misses(lower, upper)) return;

    // Halve the longest edge.
    const Vec3d& apex = corner[longest];
    const Vec3d& from = corner[(longest + 1) % 3];
    const Vec3d& to = corner[(longest + 2) % 3];
    const Vec3d middle = 0.5 * (from + to);
    sampleTriangle({apex, from, middle}, 0.5 * areaVector, depth + 1, sampling);
    sampleTriangle({apex, middle, to}, 0.5 * areaVector, depth + 1, sampling);
}

}  // namespace

MeshSource::MeshSource(std::string name, Mesh mesh)
    : mName(std::move(name)), mMesh(std::move(mesh)) {
    for (std::size_t i = 0; i < mMesh.triangles.size(); ++i) mBounds.expand(elementBounds(i));

    // Sum relative to the middle of the box: far from the origin the volumes would cancel.
    const Vec3d middle = mMesh.triangles.empty() ? Vec3d(0) : mBounds.getCenter();
    CompensatedSum volume;
    CompensatedSum area;
    for (const openvdb::Vec3I& t : mMesh.triangles) {
        const Vec3d a = mMesh.points[t[0]] - middle;
        const Vec3d b = mMesh.points[t[1]] - middle;
        const Vec3d c = mMesh.points[t[2]] - middle;
        const Vec3d normal = (b - a).cross(c - a);
        volume.add(a.dot(normal) / 6.0);
        area.add(0.5 * normal.length());
    }
    mVolume = volume.value();
    mArea = area.value();
    if (!std::isfinite(mArea) || !std::isfinite(mVolume)) {
        throw Error(ErrorKind::Input, "\"" + mName +
                                          "\" has a coordinate that is not finite, or so "
                                          "large that its volume is not; expected finite ones");
    }
}

BBoxd MeshSource::elementBounds(std::size_t i) const {
    const openvdb::Vec3I& t = mMesh.triangles[i];
    BBoxd box(mMesh.points[t[0]], mMesh.points[t[0]]);
    box.expand(mMesh.points[t[1]]);
    box.expand(mMesh.points[t[2]]);
    return box;
}

void MeshSource::sampleElement(std::size_t i, const SamplingRegion& region,
                               const SurfaceQuadrature& quadrature,
                               std::vector<SurfaceSample>& samples) const {
    requireUsefulLength(quadrature.triangleEdge.back(), "triangle edge");
    const openvdb::Vec3I& t = mMesh.triangles[i];
    std::array<Vec3d, 3> corner = {mMesh.points[t[0]] / region.voxelSize,
                                   mMesh.points[t[1]] / region.voxelSize,
                                   mMesh.points[t[2]] / region.voxelSize};
    // Work relative to a whole voxel at the triangle, so that rounding does not depend on where
    // in the world it lies: shifted by whole voxels, it gives the same samples to the last bit.
    const Vec3d base(std::floor(corner[0][0]), std::floor(corner[0][1]), std::floor(corner[0][2]));
    for (Vec3d& c : corner) c -= base;
    const SamplingRegion local{region.voxelSize, region.origin - base, region.extent};
    const Vec3d areaVector = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (areaVector.lengthSqr() == 0.0) return;
    sampleTriangle(corner, areaVector, 0, {quadrature, RegionClip(local), samples});
}

}  // namespace bandvox

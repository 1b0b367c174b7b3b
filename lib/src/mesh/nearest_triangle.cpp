#include "mesh/nearest_triangle.h"

#include <openvdb/math/Proximity.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace bandvox {

using openvdb::Vec3d;

namespace {

std::vector<openvdb::BBoxd> boxesOf(const Mesh& mesh) {
    std::vector<openvdb::BBoxd> boxes;
    boxes.reserve(mesh.triangles.size());
    for (const openvdb::Vec3I& t : mesh.triangles) {
        openvdb::BBoxd box(mesh.points[t[0]], mesh.points[t[0]]);
        box.expand(mesh.points[t[1]]);
        box.expand(mesh.points[t[2]]);
        boxes.push_back(box);
    }
    return boxes;
}

}  // namespace

NearestTriangle::NearestTriangle(Mesh mesh) : mMesh(std::move(mesh)), mTree(boxesOf(mMesh)) {}

Vec3d NearestTriangle::nearestOn(std::uint32_t triangle, const Vec3d& place) const {
    const openvdb::Vec3I& t = mMesh.triangles[triangle];
    Vec3d weights;
    return openvdb::math::closestPointOnTriangleToPoint(mMesh.points[t[0]], mMesh.points[t[1]],
                                                        mMesh.points[t[2]], place, weights);
}

std::optional<NearestPoint> NearestTriangle::find(const Vec3d& place, double distance,
                                                  std::optional<std::uint32_t> guess) const {
    // The bound is beyond what counts, so that one at the very distance is found.
    double bound = std::nextafter(distance * distance, std::numeric_limits<double>::infinity());
    std::optional<NearestPoint> nearest;
    const auto visit = [&](std::uint32_t triangle) {
        const Vec3d there = nearestOn(triangle, place);
        const double square = (there - place).lengthSqr();
        // Of several that are as near the first one counts, whatever the guess was.
        const bool isNearer =
            square < bound || (nearest && square == bound && triangle < nearest->triangle);
        if (!isNearer) return;
        nearest = {there, triangle, square};
        bound = square;
    };
    if (guess) visit(*guess);
    // Boxes that are as near as the bound have to be looked at, too.
    double reach = std::nextafter(bound, std::numeric_limits<double>::infinity());
    mTree.visitNearer(place, reach, [&](std::uint32_t triangle) {
        visit(triangle);
        reach = std::nextafter(bound, std::numeric_limits<double>::infinity());
    });
    return nearest;
}

}  // namespace bandvox

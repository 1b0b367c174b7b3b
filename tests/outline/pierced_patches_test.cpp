// Where patches pass through volumes, against the circle in which two balls meet.

#include "outline/volumes/pierced_patches.h"

#include "outline/drawn_distance.h"
#include "outline/filled_page.h"
#include "outline/sample_surfaces.h"
#include "outline/volume_shapes.h"
#include "outline/volume_views.h"

#include <bandvox/outline/volumes_to_outline.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox::outline_test {
namespace {

using openvdb::Vec3d;

const Vec3d kOfPatches(-0.3, 0.05, 0.02), kOfVolume(0.35, -0.1, 0.1);
constexpr double kSize = 0.6;

PatchModel patchBall() {
    return {mapped(sphere(kSize), {{{1, 0, 0, kOfPatches[0]},
                                    {0, 0.6, -0.8, kOfPatches[1]},
                                    {0, 0.8, 0.6, kOfPatches[2]}}}),
            {"patches"},
            {}};
}

std::vector<OutlineVolume> volumeBall(const openvdb::math::Transform::Ptr& lattice) {
    return {{levelSet([](const Vec3d& p) { return ballDistance(p, kOfVolume, kSize); }, lattice),
             {},
             "volume"}};
}

TEST(PiercedPatches, MeetABallInACircle) {
    const PatchModel patches = patchBall();
    const OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.3), false);
    for (const auto& lattice : {plainLattice(), turnedLattice()}) {
        const VolumeDrawing drawing(volumeBall(lattice), patches, options, silentProgress());
        int found = 0;
        for (const Curve& curve : drawing.curves()) {
            if (curve.kind != OutlineKind::Intersection) continue;
            ++found;
            EXPECT_TRUE(curve.closed);
            double length = 0;
            Vec3d last;
            for (std::size_t i = 0; i < curve.points.size(); ++i) {
                const CurvePoint& p = curve.points[i];
                const auto& patch = patches.patches[static_cast<std::size_t>(p.patch)];
                const auto place = evaluate(patch, p.u, p.v).position;
                const Vec3d world(place[0], place[1], place[2]);
                EXPECT_NEAR(ballDistance(world, kOfVolume, kSize), 0, 2e-4);
                if (i > 0) length += (world - last).length();
                last = world;
            }
            const double half = 0.5 * (kOfVolume - kOfPatches).length();
            const double radius = std::sqrt(kSize * kSize - half * half);
            EXPECT_NEAR(length, 2 * std::numbers::pi * radius, 0.002);
        }
        EXPECT_EQ(found, 1);
    }
}

// Where a line of sight to the middle of the page's place enters a ball, along the camera's back;
// -1e9 if it does not.
double frontOf(const Vec3d& center, const Camera& camera, double right, double up) {
    const double dx = right - center.dot(camera.right()), dy = up - center.dot(camera.upward());
    const double square = kSize * kSize - dx * dx - dy * dy;
    if (square < 0) return -1e9;
    return std::sqrt(square) - center.dot(camera.forward());
}

TEST(PiercedPatches, AreFilledUpToTheVolume) {
    const PatchModel patches = patchBall();
    for (const Vec3d& from : {Vec3d(0.2, -1, 0.3), Vec3d(1, 0.4, 0.5), Vec3d(-0.7, -0.6, 0.4)}) {
        OutlineOptions options = fixedView(from, false);
        options.fill = OutlineFillKind::Flat;
        // Their curves are needed for that, drawn or not.
        options.intersections = false;
        const Outline outline = volumesToOutline(volumeBall(plainLattice()), patches, options);
        for (const OutlinePath& path : outline.paths) {
            EXPECT_NE(path.kind, OutlineKind::Intersection);
        }
        const Camera camera(options.camera, 100, 100, openvdb::BBoxd(Vec3d(-1.0), Vec3d(1.0)));
        const FilledPage page(outline, 0.5);
        const double scale =
            options.camera.frame / (std::min(options.width, options.height) - 2 * options.margin);
        std::array<int, 3> looked{};
        for (int j = 0; j < page.height(); ++j) {
            for (int i = 0; i < page.width(); ++i) {
                if (page.isNearEdge(i, j)) continue;
                const auto [x, y] = page.middle(i, j);
                const double right = (x - 0.5 * options.width) * scale;
                const double up = (0.5 * options.height - y) * scale;
                const double a = frontOf(kOfPatches, camera, right, up);
                const double b = frontOf(kOfVolume, camera, right, up);
                const int expected = std::max(a, b) < -1e8 ? -1 : a > b ? 0 : 1;
                const int fill = page.fillAt(i, j);
                const int object =
                    fill < 0 ? -1 : outline.fills[static_cast<std::size_t>(fill)].object;
                EXPECT_EQ(object, expected) << from << " at " << x << ", " << y;
                ++looked[static_cast<std::size_t>(expected + 1)];
            }
        }
        for (const int count : looked) EXPECT_GT(count, 500);
    }
}

TEST(PiercedPatches, OfAPlaneGoAcrossItsParts) {
    // Nine bilinear parts of a plane, through a ball.
    PatchModel plane{{}, {"plane"}, {}};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            BezierPatch part{.degreeU = 1, .degreeV = 1};
            for (const int di : {0, 1}) {
                for (const int dj : {0, 1}) {
                    part.control.push_back(
                        {-1 + (i + di) / 1.5, -1 + (j + dj) / 1.5, 0.2 + 0.1 * (i + di), 1});
                }
            }
            plane.patches.push_back(part);
        }
    }
    const OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.8), false);
    const VolumeDrawing drawing(volumeBall(turnedLattice()), plane, options, silentProgress());
    int found = 0;
    for (const Curve& curve : drawing.curves()) {
        if (curve.kind != OutlineKind::Intersection) continue;
        ++found;
        EXPECT_TRUE(curve.closed);
        for (const CurvePoint& p : curve.points) EXPECT_FALSE(p.corner);
    }
    EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace bandvox::outline_test

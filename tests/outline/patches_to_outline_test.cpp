// Drawings of surfaces against closed forms, and against the true curves.

#include "outline/drawn_distance.h"
#include "outline/scenes.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/outline/patches_to_outline.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace bandvox::outline_test {
namespace {

TEST(PatchesToOutline, DrawsASphereAsACircleOfFewCubics) {
    // 200 units of the page are 2.5 of the world.
    const PatchModel model{sphere(1), {"sphere"}, {}};
    constexpr double kRadius = 80;
    for (const openvdb::Vec3d from :
         {openvdb::Vec3d(0.3, 0.7, 0.4), openvdb::Vec3d(1, 0, 0), openvdb::Vec3d(1, 1, 1)}) {
        OutlineOptions options = parallelView(from, 2.5);
        options.tolerance = 0.9e-5 * kRadius;
        const Outline outline = patchesToOutline(model, options);
        ASSERT_EQ(outline.paths.size(), 1U) << from;
        const OutlinePath& path = outline.paths[0];
        EXPECT_TRUE(path.closed);
        EXPECT_EQ(path.hidden, 0);
        EXPECT_LE(path.anchors(), 8U);
        double worst = 0;
        alongPath(path, 50, [&](const Place& p) {
            worst = std::max(worst, std::abs(std::hypot(p[0] - 110, p[1] - 110) - kRadius));
        });
        EXPECT_LT(worst, 1e-5 * kRadius) << from;
    }
}

TEST(PatchesToOutline, DrawsEllipsoidsAsTheClosedFormHasThem) {
    // x = A n with |n| = 1 is seen along d as the ellipse of |(M M^T)^-1/2 y| = 1, where M is A
    // projected.
    const std::array<std::array<double, 4>, 3> a{
        {{1.1, 0.2, 0.1, 0}, {-0.3, 0.7, 0.2, 0}, {0.1, -0.1, 0.5, 0}}};
    const PatchModel model{mapped(sphere(1), a), {"ellipsoid"}, {}};
    for (int view = 0; view < 20; ++view) {
        const double azimuth = 0.31 * view, elevation = 1.2 * std::sin(0.7 * view);
        const double ca = std::cos(azimuth), sa = std::sin(azimuth);
        const double ce = std::cos(elevation), se = std::sin(elevation);
        OutlineOptions options = parallelView({ce * ca, ce * sa, se}, 4);
        options.tolerance = 1e-3;
        const Outline outline = patchesToOutline(model, options);
        ASSERT_EQ(outline.paths.size(), 1U);
        EXPECT_TRUE(outline.paths[0].closed);
        const std::array<std::array<double, 3>, 2> axes{{{-sa, ca, 0}, {-se * ca, -se * sa, ce}}};
        double mm[2][2] = {{0, 0}, {0, 0}};
        std::array<std::array<double, 3>, 2> m{};
        for (std::size_t r = 0; r < 2; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t k = 0; k < 3; ++k) m[r][c] += axes[r][k] * a[k][c];
            }
        }
        for (std::size_t r = 0; r < 2; ++r) {
            for (std::size_t s = 0; s < 2; ++s) {
                for (std::size_t k = 0; k < 3; ++k) mm[r][s] += m[r][k] * m[s][k];
            }
        }
        const double determinant = mm[0][0] * mm[1][1] - mm[0][1] * mm[1][0];
        alongPath(outline.paths[0], 20, [&](const Place& p) {
            const double x = (p[0] - 110) / 50, y = -(p[1] - 110) / 50;
            const double gx = (mm[1][1] * x - mm[0][1] * y) / determinant;
            const double gy = (mm[0][0] * y - mm[1][0] * x) / determinant;
            const double distance = (x * gx + y * gy - 1) / (2 * std::hypot(gx, gy));
            EXPECT_LT(std::abs(distance) * 50, 2e-3);
        });
    }
}

TEST(PatchesToOutline, DoesNotDependOnTheNumberOfThreads) {
    PatchModel model{torus(1, 0.4), {"torus"}, {}};
    const OutlineOptions options = parallelView({1, 0.3, 0.4}, 3);
    std::vector<Outline> results;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        results.push_back(patchesToOutline(model, options));
    }
    ASSERT_EQ(results[0].paths.size(), results[1].paths.size());
    for (std::size_t k = 0; k < results[0].paths.size(); ++k) {
        EXPECT_EQ(results[0].paths[k].points, results[1].paths[k].points);
        EXPECT_EQ(results[0].paths[k].hidden, results[1].paths[k].hidden);
    }
}

// A line of meeting that turns back within a few hundredths of a millimetre: cubics may bulge
// between the points that hold them.
TEST(PatchesToOutline, KeepsToACurveThatTurnsBackSharply) {
    const PatchModel model{twoTeapots(), {"a", "b"}, {}};
    const double azimuth = 2 * std::numbers::pi * 20.2 / 26;
    const OutlineOptions options = viewFrom(azimuth, 1, true);
    EXPECT_LE(largestDistance(patchesToOutline(model, options), model, options), options.tolerance);
}

TEST(PatchesToOutline, KeepsToTheTrueCurves) {
    for (const Scene& scene : {Scene{"teapot", teapot()}, Scene{"two tori", twoTori()}}) {
        const PatchModel model{scene.patches, {"a", "b"}, {}};
        for (const double azimuth : {-1.1, 1.9, 2.5}) {
            const OutlineOptions options = viewFrom(azimuth, 0.4, azimuth > 0);
            const Outline outline = patchesToOutline(model, options);
            EXPECT_LE(largestDistance(outline, model, options), options.tolerance)
                << scene.name << " from " << azimuth;
            std::size_t anchors = 0;
            for (const OutlinePath& path : outline.paths) {
                if (path.hidden == 0) anchors += path.anchors();
            }
            EXPECT_LE(anchors, 200U) << scene.name << " from " << azimuth;
        }
    }
}

TEST(PatchesToOutline, FindsWhereSpheresMeet) {
    PatchModel model{sphere(1), {"a", "b"}, {}};
    const auto other = mapped(sphere(1), {{{1, 0, 0, 0.9}, {0, 1, 0, 0.13}, {0, 0, 1, 0.21}}});
    for (BezierPatch patch : other) {
        patch.object = 1;
        model.patches.push_back(patch);
    }
    OutlineOptions options = parallelView({0, -1, 0}, 4);
    const Outline outline = patchesToOutline(model, options);
    // The circle lies in the plane between the centers.
    double length = 0;
    Place last{};
    bool isFirst = true;
    for (const OutlinePath& path : outline.paths) {
        if (path.kind != OutlineKind::Intersection) continue;
        isFirst = true;
        alongPath(path, 30, [&](const Place& p) {
            if (!isFirst) length += std::hypot(p[0] - last[0], p[1] - last[1]);
            isFirst = false;
            last = p;
        });
    }
    // An ellipse: the radius is r = sqrt(1 - |c|^2 / 4), its short axis that times |c_y| / |c|.
    const double c = std::sqrt(0.9 * 0.9 + 0.13 * 0.13 + 0.21 * 0.21);
    const double a = 50 * std::sqrt(1 - c * c / 4), b = a * 0.13 / c;
    double expected = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.5) / kSteps;
        expected +=
            std::hypot(a * std::sin(angle), b * std::cos(angle)) * 2 * std::numbers::pi / kSteps;
    }
    EXPECT_NEAR(length, expected, 0.02);
}

TEST(PatchesToOutline, RefusesWhatCannotBeDrawn) {
    const auto kindOf = [](const PatchModel& model, const OutlineOptions& options) {
        try {
            patchesToOutline(model, options);
        } catch (const Error& error) {
            return error.exitStatus();
        }
        return 0;
    };
    const PatchModel ball{sphere(1), {"ball"}, {}};
    OutlineOptions options = parallelView({1, 0, 0}, 4);
    EXPECT_EQ(kindOf({}, options), 4);
    options.tolerance = 0;
    EXPECT_EQ(kindOf(ball, options), 2);
    options = parallelView({1, 0, 0}, 4);
    options.camera.projection = CameraOptions::Projection::Perspective;
    options.camera.eye = openvdb::Vec3d(0.1, 0, 0);
    EXPECT_EQ(kindOf(ball, options), 2);
    PatchModel broken = ball;
    broken.patches[0].control[4][3] = 0;
    EXPECT_EQ(kindOf(broken, parallelView({1, 0, 0}, 4)), 3);
}

TEST(PatchesToOutline, EndsQuicklyWithAThousandPatchesOnAPoint) {
    PatchModel model{{}, {"points"}, {}};
    BezierPatch patch{.degreeU = 3, .degreeV = 3};
    patch.control.assign(16, {0.1, 0.2, 0.3, 1});
    model.patches.assign(1000, patch);
    EXPECT_THROW(patchesToOutline(model, parallelView({1, 0.2, 0.3}, 4)), Error);
}

// A quarter of a cylinder's wall around z, from z = 0 up.
BezierPatch quarterWall(double radius, int quarter) {
    BezierPatch patch{.degreeU = 2, .degreeV = 1};
    for (const auto& c : quarterCircle()) {
        const auto p = turned(c, quarter);
        for (const double z : {0.0, 1.0}) {
            patch.control.push_back({radius * p[0], radius * p[1], z * p[2], p[2]});
        }
    }
    patch.object = 1;
    return patch;
}

BezierPatch square(double half, double z) {
    BezierPatch patch{.degreeU = 1, .degreeV = 1};
    for (const double x : {-half, half}) {
        for (const double y : {-half, half}) patch.control.push_back({x, y, z, 1});
    }
    return patch;
}

TEST(PatchesToOutline, DrawsTheFootOfWhatStandsOnAPlaneOnce) {
    // The wall's border lies in the plane: a circle of radius 0.5.
    PatchModel model{{square(1, 0)}, {"plane", "wall"}, {}};
    for (int q = 0; q < 4; ++q) model.patches.push_back(quarterWall(0.5, q));
    for (const double tolerance : {0.1, 0.02, 0.01, 0.005, 0.001}) {
        OutlineOptions options = parallelView(openvdb::Vec3d(1, -2, 1), 3);
        options.tolerance = tolerance;
        const Outline outline = patchesToOutline(model, options);
        const Camera camera(options.camera, 100, 100,
                            openvdb::BBoxd(openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0)));
        const openvdb::Vec3d right = camera.right(), up = camera.upward();
        const double area = right[0] * up[1] - right[1] * up[0];
        double length = 0;
        for (const OutlinePath& path : outline.paths) {
            if (path.kind != OutlineKind::Intersection) continue;
            std::array<double, 2> before{HUGE_VAL, 0};
            alongPath(path, 50, [&](const Place& p) {
                // The place of the plane z = 0 that is seen there.
                const double x = (p[0] - 110) * 3 / 200, y = (110 - p[1]) * 3 / 200;
                const std::array<double, 2> w{(x * up[1] - y * right[1]) / area,
                                              (y * right[0] - x * up[0]) / area};
                EXPECT_NEAR(std::hypot(w[0], w[1]), 0.5, 0.05 * tolerance + 1e-6);
                if (before[0] < HUGE_VAL) length += std::hypot(w[0] - before[0], w[1] - before[1]);
                before = w;
            });
        }
        EXPECT_NEAR(length, std::numbers::pi, 0.02) << tolerance;
        EXPECT_LT(outline.paths.size(), 20U) << tolerance;
    }
}

TEST(PatchesToOutline, FindsWhereLargePatchesCross) {
    std::mt19937 random(5);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int k = 0; k < 40; ++k) {
        // A rectangle through the plane z = 0 along x = a, from y = -h to h.
        const double a = number(-0.9, 0.9), h = number(0.3, 0.9), turn = number(0.3, 1.5);
        BezierPatch wall{.degreeU = 1, .degreeV = 1};
        for (const double z : {-number(0.1, 1.5), number(0.1, 1.5)}) {
            for (const double y : {-h, h}) {
                wall.control.push_back({a + std::cos(turn) * z, y, std::sin(turn) * z, 1});
            }
        }
        const openvdb::Vec3d from(number(-1, 1), number(-1, 1), number(0.2, 1));
        const OutlineOptions options = parallelView(from, 2.6);
        const Outline outline =
            patchesToOutline({{square(1, 0), wall}, {"floor", "wall"}, {}}, options);
        const Camera camera(options.camera, 100, 100,
                            openvdb::BBoxd(openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0)));
        double length = 0;
        for (const OutlinePath& path : outline.paths) {
            if (path.kind != OutlineKind::Intersection) continue;
            const auto &first = path.points.front(), &last = path.points.back();
            length += std::hypot(last[0] - first[0], last[1] - first[1]);
        }
        const openvdb::Vec3d y(0, 1, 0);
        const double expected =
            2 * h * std::hypot(y.dot(camera.right()), y.dot(camera.upward())) * 200 / 2.6;
        EXPECT_NEAR(length, expected, 0.02) << k;
    }
}

TEST(PatchesToOutline, DrawsNoIntersectionWhereSolidsTouch) {
    // A ball and a torus that lie on a plane, and a box's face in another one's.
    const auto raised = [](std::vector<BezierPatch> patches, double by) {
        return mapped(std::move(patches), {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, by}}});
    };
    for (const auto& standing : {raised(sphere(0.5), 0.5), raised(torus(0.6, 0.25), 0.25),
                                 std::vector<BezierPatch>{square(0.5, 0)}}) {
        const PatchModel model{together({square(1, 0)}, standing), {"plane", "solid"}, {}};
        const Outline outline = patchesToOutline(model, parallelView(openvdb::Vec3d(1, -2, 1), 3));
        for (const OutlinePath& path : outline.paths) {
            EXPECT_NE(path.kind, OutlineKind::Intersection);
        }
        EXPECT_LT(outline.paths.size(), 20U);
    }
}

}  // namespace
}  // namespace bandvox::outline_test

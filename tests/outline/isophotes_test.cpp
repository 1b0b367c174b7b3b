// Isophotes of patches against closed forms and against normals along them.

#include "outline/patches/isophotes.h"

#include "outline/drawing/page_view.h"
#include "outline/filled_page.h"
#include "outline/scenes.h"

#include <bandvox/outline/patches_to_outline.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox::outline_test {
namespace {

TEST(Isophotes, OfASphereAreCirclesAroundTheLight) {
    const PatchModel ball{sphere(1), {"sphere"}, {}};
    OutlineOptions options = parallelView(openvdb::Vec3d(0.3, 0.7, 0.4), 2.5);
    options.isophotes = {-0.2, 0, 0.6, 0.95};
    const openvdb::Vec3d light = options.light.unit();
    const Outline outline = patchesToOutline(ball, options);
    int visible = 0;
    for (const OutlinePath& path : outline.paths) {
        if (path.kind != OutlineKind::Isophote || path.hidden > 0) continue;
        ++visible;
        double least = 1, most = -1;
        alongCubics(path.points, 20, [&](const auto& p) {
            const double x = (p[0] - 110) / 80, y = (110 - p[1]) / 80;
            const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
            const double cosine = x * light[0] + y * light[1] + z * light[2];
            // Where the sphere is steep a small distance changes the angle by much.
            if (z < 0.2) return;
            least = std::min(least, cosine);
            most = std::max(most, cosine);
        });
        EXPECT_LT(most - least, 2e-3);
        const double middle = 0.5 * (least + most);
        double nearest = 1;
        for (const double c : options.isophotes) nearest = std::min(nearest, std::abs(c - middle));
        EXPECT_LT(nearest, 1e-3) << middle;
        EXPECT_EQ(path.closed, middle > 0.7);
    }
    EXPECT_EQ(visible, 4);
}

TEST(Isophotes, HaveTheAngleEverywhereOnRationalAndCollapsedPatches) {
    for (const Scene& scene : {Scene{"torus", torus(1, 0.4)}, Scene{"teapot", teapot()}}) {
        OutlineOptions options = viewFrom(0.9, 0.4, false);
        const ViewMatrix view = pageView(scene.patches, options);
        const std::vector<ViewPatch> seen = seenBy(view, scene.patches, 200);
        const LitPatches lit{scene.patches, seen, {0.36, 0.48, 0.8}};
        int points = 0;
        for (int k = 0; k < static_cast<int>(seen.size()); ++k) {
            for (const double cosine : {0.0, 0.3, 0.85}) {
                for (const Curve& curve : isophoteCurves(lit, k, cosine, {1e-3, 200})) {
                    for (std::size_t i = 0; i < curve.points.size(); ++i) {
                        const CurvePoint& p = curve.points[i];
                        EXPECT_NEAR(std::abs(lightCosine(lit, k, p.u, p.v)), cosine, 1e-5)
                            << scene.name << " " << k << " at " << p.u << ", " << p.v;
                        ++points;
                        if (i == 0) continue;
                        const CurvePoint middle = isophoteBetween(lit, curve.points[i - 1], p, 0.4);
                        EXPECT_NEAR(std::abs(lightCosine(lit, k, middle.u, middle.v)), cosine,
                                    1e-5);
                    }
                }
            }
        }
        EXPECT_GT(points, 1000) << scene.name;
    }
}

TEST(Isophotes, OfAPlaneAreNone) {
    BezierPatch plane{.degreeU = 1, .degreeV = 1};
    plane.control = {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}};
    const PatchModel model{{plane}, {"plane"}, {}};
    OutlineOptions options = viewFrom(0.2, 1.2, false);
    options.isophotes = {-0.5, 0, 0.5};
    for (const OutlinePath& path : patchesToOutline(model, options).paths) {
        EXPECT_EQ(path.kind, OutlineKind::Boundary);
    }
}

}  // namespace
}  // namespace bandvox::outline_test

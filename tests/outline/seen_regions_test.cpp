// Fills against exact lines of sight, closed forms and what overlaps in a cycle.

#include "outline/drawn_view.h"
#include "outline/filled_page.h"
#include "outline/scenes.h"

#include <bandvox/core/error.h>
#include <bandvox/outline/patches_to_outline.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace bandvox::outline_test {
namespace {

double areaOf(const OutlineFill& fill) {
    double area = 0;
    for (const auto& loop : fill.loops) {
        std::array<double, 2> before = loop.front();
        alongCubics(loop, 200, [&](const auto& p) {
            area += 0.5 * (before[0] * p[1] - before[1] * p[0]);
            before = p;
        });
    }
    return std::abs(area);
}

OutlineOptions filledView(const openvdb::Vec3d& from, double frame, OutlineFillKind fill) {
    OutlineOptions options = parallelView(from, frame);
    options.fill = fill;
    return options;
}

// A flat bar between two places, at heights of its own, seen from above.
BezierPatch bar(const std::array<double, 3>& a, const std::array<double, 3>& b, int object) {
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double length = std::hypot(dx, dy), nx = -0.2 * dy / length, ny = 0.2 * dx / length;
    BezierPatch patch{.degreeU = 1, .degreeV = 1};
    for (const auto& end : {a, b}) {
        patch.control.push_back({end[0] + nx, end[1] + ny, end[2], 1});
        patch.control.push_back({end[0] - nx, end[1] - ny, end[2], 1});
    }
    patch.object = object;
    return patch;
}

TEST(SeenRegions, FillASphereAndTheHoleOfATorus) {
    const PatchModel ball{sphere(1), {"sphere"}, {}};
    const Outline disc =
        patchesToOutline(ball, filledView({0.3, 0.7, 0.4}, 2.5, OutlineFillKind::Flat));
    ASSERT_EQ(disc.fills.size(), 1U);
    EXPECT_EQ(disc.tones, 1);
    EXPECT_EQ(disc.fills[0].loops.size(), 1U);
    EXPECT_NEAR(areaOf(disc.fills[0]), std::numbers::pi * 80 * 80,
                2 * std::numbers::pi * 80 * 0.01);

    const PatchModel ring{torus(1, 0.3), {"torus"}, {}};
    const Outline pierced =
        patchesToOutline(ring, filledView({0.1, 0.1, 1}, 3, OutlineFillKind::Flat));
    ASSERT_EQ(pierced.fills.size(), 1U);
    EXPECT_EQ(pierced.fills[0].loops.size(), 2U);
}

TEST(SeenRegions, NeedNoOrderWhereObjectsOverlapInACycle) {
    // Each bar begins above the next one and ends below the one before.
    std::vector<BezierPatch> bars;
    for (int k = 0; k < 3; ++k) {
        const double a = 2 * std::numbers::pi * k / 3, b = a + 2 * std::numbers::pi * 0.42;
        bars.push_back(bar({std::cos(a), std::sin(a), 0.3}, {std::cos(b), std::sin(b), -0.3}, k));
    }
    const PatchModel model{bars, {"a", "b", "c"}, {}};
    const OutlineOptions options = filledView({0, 0.01, 1}, 3, OutlineFillKind::Flat);
    const Outline outline = patchesToOutline(model, options);
    const DrawnView drawn = draw(model.patches, options);
    std::vector<ExactSheets> sheets;
    sheets.reserve(3);
    for (std::size_t k = 0; k < 3; ++k) sheets.emplace_back(std::span(drawn.seen).subspan(k, 1));
    const FilledPage page(outline, 1);
    std::array<int, 3> seen{};
    for (int j = 0; j < page.height(); ++j) {
        for (int i = 0; i < page.width(); ++i) {
            if (page.isNearEdge(i, j)) continue;
            const auto [x, y] = page.middle(i, j);
            int first = -1;
            double nearest = HUGE_VAL;
            for (int k = 0; k < 3; ++k) {
                const auto depths = sheets[static_cast<std::size_t>(k)].depthsBefore(x, y, 1e9);
                if (depths.empty() || depths[0] >= nearest) continue;
                nearest = depths[0];
                first = k;
            }
            const int fill = page.fillAt(i, j);
            EXPECT_EQ(fill < 0 ? -1 : outline.fills[static_cast<std::size_t>(fill)].object, first)
                << x << ", " << y;
            EXPECT_LE(page.layersAt(i, j), 1);
            if (first >= 0) ++seen[static_cast<std::size_t>(first)];
        }
    }
    // Each is over one and under another one: all three show about the same.
    for (const int count : seen) EXPECT_GT(count, 1000);
}

TEST(SeenRegions, AgreeWithExactLinesOfSightOnScenes) {
    for (const Scene& scene : scenes()) {
        OutlineOptions options = viewFrom(0.7, 0.35, scene.name == "two tori");
        options.fill = OutlineFillKind::Flat;
        const PatchModel model{scene.patches, {"a", "b"}, {}};
        const Outline outline = patchesToOutline(model, options);
        const DrawnView drawn = draw(model.patches, options);
        std::array<std::vector<ViewPatch>, 2> parts;
        for (const ViewPatch& patch : drawn.seen) {
            parts[static_cast<std::size_t>(patch.object)].push_back(patch);
        }
        const std::array<ExactSheets, 2> sheets{ExactSheets(parts[0]), ExactSheets(parts[1])};
        const FilledPage page(outline, 2);
        int wrong = 0, layered = 0, looked = 0;
        for (int j = 0; j < page.height(); ++j) {
            for (int i = j % 2; i < page.width(); i += 2) {
                if (page.isNearEdge(i, j)) continue;
                const auto [x, y] = page.middle(i, j);
                const auto a = sheets[0].depthsBefore(x, y, 1e9);
                const auto b = sheets[1].depthsBefore(x, y, 1e9);
                int expected = a.empty() ? -1 : 0;
                if (!b.empty() && (a.empty() || b[0] < a[0])) expected = 1;
                const int fill = page.fillAt(i, j);
                const int found =
                    fill < 0 ? -1 : outline.fills[static_cast<std::size_t>(fill)].object;
                ++looked;
                wrong += found != expected ? 1 : 0;
                layered += page.layersAt(i, j) > 1 ? 1 : 0;
            }
        }
        EXPECT_EQ(wrong, 0) << scene.name << ", of " << looked;
        EXPECT_EQ(layered, 0) << scene.name;
        EXPECT_GT(looked, 1000);
    }
}

TEST(SeenRegions, HaveTheTonesOfASphere) {
    const PatchModel ball{sphere(1), {"sphere"}, {}};
    OutlineOptions options = filledView({0.3, 0.7, 0.4}, 2.5, OutlineFillKind::Toon);
    options.light = openvdb::Vec3d(-0.4, 0.7, 0.8);
    options.tones = {-0.3, 0, 0.5, 0.9};
    const Outline outline = patchesToOutline(ball, options);
    EXPECT_EQ(outline.tones, 5);
    const openvdb::Vec3d light = options.light.unit();
    const FilledPage page(outline, 1);
    int looked = 0;
    for (int j = 0; j < page.height(); ++j) {
        for (int i = 0; i < page.width(); ++i) {
            const auto [x, y] = page.middle(i, j);
            const double right = (x - 110) / 80, up = (110 - y) / 80;
            const double square = right * right + up * up;
            if (page.isNearEdge(i, j) || square > 1) continue;
            const double cosine =
                right * light[0] + up * light[1] + std::sqrt(1 - square) * light[2];
            const auto tone =
                static_cast<int>(std::count_if(options.tones.begin(), options.tones.end(),
                                               [&](double limit) { return cosine > limit; }));
            const int fill = page.fillAt(i, j);
            ASSERT_GE(fill, 0);
            EXPECT_EQ(outline.fills[static_cast<std::size_t>(fill)].tone, tone) << x << ", " << y;
            ++looked;
        }
    }
    EXPECT_GT(looked, 15000);
    // What only tells tones apart is not drawn.
    for (const OutlinePath& path : outline.paths) EXPECT_EQ(path.kind, OutlineKind::Contour);
}

TEST(SeenRegions, ShowTheFirstOfObjectsInTheSamePlace) {
    PatchModel twice{together(torus(1, 0.3), torus(1, 0.3)), {"first", "second"}, {}};
    for (const openvdb::Vec3d& from : {openvdb::Vec3d(0.3, 0.7, 0.4), openvdb::Vec3d(0, 0.1, 1)}) {
        const Outline outline = patchesToOutline(twice, filledView(from, 3, OutlineFillKind::Flat));
        ASSERT_EQ(outline.fills.size(), 1U);
        EXPECT_EQ(outline.fills[0].object, 0);
    }
}

TEST(SeenRegions, ShareTheirBordersToTheLastDigit) {
    OutlineOptions options = viewFrom(0.7, 0.35, false);
    options.fill = OutlineFillKind::Toon;
    const PatchModel model{teapot(), {"teapot"}, {}};
    const Outline outline = patchesToOutline(model, options);
    // An anchor of two regions' borders has the same handles in both, or it is a junction.
    std::map<std::array<double, 4>, int> segments;
    std::size_t count = 0;
    for (const OutlineFill& fill : outline.fills) {
        for (const auto& loop : fill.loops) {
            EXPECT_EQ(loop.front(), loop.back());
            for (std::size_t i = 0; i + 3 < loop.size(); i += 3) {
                const auto &a = std::min(loop[i + 1], loop[i + 2]),
                           &b = std::max(loop[i + 1], loop[i + 2]);
                ++segments[{a[0], a[1], b[0], b[1]}];
                ++count;
            }
        }
    }
    std::size_t shared = 0;
    for (const auto& [handles, uses] : segments) {
        EXPECT_LE(uses, 2);
        shared += uses == 2 ? 1 : 0;
    }
    EXPECT_GT(outline.fills.size(), 10U);
    EXPECT_GT(shared, count / 5);
}

TEST(SeenRegions, AreRefusedForTonesThatAreNone) {
    const PatchModel ball{sphere(1), {"sphere"}, {}};
    for (const std::vector<double>& tones :
         {std::vector<double>{}, {0.5, 0.5}, {0.7, 0.2}, {-1.0}, {1.0}, {std::nan("")}}) {
        OutlineOptions options = viewFrom(0, 0, false);
        options.fill = OutlineFillKind::Toon;
        options.tones = tones;
        EXPECT_THROW(patchesToOutline(ball, options), Error);
    }
}

}  // namespace
}  // namespace bandvox::outline_test

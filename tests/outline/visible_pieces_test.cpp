// What is hidden, against rays on fine triangles; every free end has to have a reason.

#include "outline/visible_pieces.h"

#include "outline/page_view.h"
#include "outline/refine_point.h"
#include "outline/sample_surfaces.h"
#include "outline/surface_curves.h"
#include "outline/triangle_sheets.h"

#include <bandvox/source/bspline_patch.h>
#include <bandvox/source/read_patches.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

namespace bandvox::outline_test {
namespace {

const std::filesystem::path kTeapot =
    std::filesystem::path(BANDVOX_SOURCE_DIR) / "examples" / "data" / "teapot.bpt";

struct Drawn {
    std::vector<ViewPatch> seen;
    std::vector<VisiblePiece> pieces;
    double size = 0, pixel = 0;
};

Drawn draw(const std::vector<BezierPatch>& patches, const OutlineOptions& options) {
    Drawn drawn;
    drawn.size = std::max(options.width, options.height);
    drawn.pixel = drawn.size / 1000;
    const ViewMatrix view = pageView(patches, options);
    for (const BezierPatch& patch : patches) {
        drawn.seen.push_back(seenBy(view, patch, drawn.size));
    }
    const CurveSampling sampling{.flatness = 0.25 * options.tolerance, .size = drawn.size};
    const auto curves = surfaceCurves(patches, drawn.seen, options, sampling, silentProgress());
    drawn.pieces =
        visiblePieces(curves, drawn.seen, Sheets(drawn.seen), sampling, silentProgress());
    return drawn;
}

OutlineOptions viewFrom(double azimuth, double elevation, bool isPerspective) {
    OutlineOptions options;
    using Projection = CameraOptions::Projection;
    options.camera.projection = isPerspective ? Projection::Perspective : Projection::Orthographic;
    options.camera.from =
        openvdb::Vec3d(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    options.camera.up = openvdb::Vec3d(0, 0, 1);
    return options;
}

struct Checked {
    int samples = 0, wrong = 0;
};

/// Compares ten or more samples of each piece with rays on triangles. Triangles are not where the
/// surface is: what is in front has to be so by `margin`.
Checked check(const Drawn& drawn, int steps, double margin) {
    const TriangleSheets oracle(drawn.seen, steps, drawn.size);
    Checked result;
    for (const auto& [curve, hidden] : drawn.pieces) {
        double length = 0;
        std::vector<double> lengths{0};
        for (std::size_t i = 1; i < curve.points.size(); ++i) {
            length += std::hypot(curve.points[i].x - curve.points[i - 1].x,
                                 curve.points[i].y - curve.points[i - 1].y);
            lengths.push_back(length);
        }
        const double away = curve.closed ? 0 : 0.2 * drawn.pixel;
        if (length <= 2 * away) continue;
        const int count = std::max(10, static_cast<int>(length / (5 * drawn.pixel)));
        for (int k = 0; k < count; ++k) {
            const double at = away + (length - 2 * away) * (k + 0.5) / count;
            const auto above = std::upper_bound(lengths.begin(), lengths.end(), at);
            const auto i =
                std::min(static_cast<std::size_t>(above - lengths.begin()), lengths.size() - 1);
            const double step = lengths[i] - lengths[i - 1];
            const CurvePoint p = pointBetween(drawn.seen, curve.points[i - 1], curve.points[i],
                                              step > 0 ? (at - lengths[i - 1]) / step : 0);
            const double nearest = oracle.nearest(p.x, p.y);
            const bool isClear = !(nearest < p.z - 0.01 * margin),
                       isHidden = nearest < p.z - margin;
            ++result.samples;
            // What is just in front may be the curve's own surface, or not.
            if (hidden == 0 ? !isHidden : !isClear) continue;
            ++result.wrong;
        }
    }
    return result;
}

TEST(VisiblePieces, OfTheTeapotAgreeWithRaysOnTriangles) {
    const auto patches = readPatches(kTeapot).patches;
    constexpr int kAzimuths = 3;
    Checked whole;
    for (const double elevation : {-0.2, 0.35, 1.0}) {
        for (int k = 0; k < kAzimuths; ++k) {
            for (const bool isPerspective : {false, true}) {
                const double azimuth = 2 * std::numbers::pi * (k + 0.2) / kAzimuths;
                const Checked checked =
                    check(draw(patches, viewFrom(azimuth, elevation, isPerspective)), 150, 0.4);
                whole.samples += checked.samples;
                whole.wrong += checked.wrong;
            }
        }
    }
    EXPECT_GT(whole.samples, 20000);
    // Triangles are wrong about a few samples themselves: they miss what is thinner than their sag.
    EXPECT_LE(whole.wrong, whole.samples / 500) << whole.samples;
}

TEST(VisiblePieces, OfATorusAgreeWithRaysOnTriangles) {
    for (const double elevation : {0.05, 0.1, 0.4, 1.3}) {
        const Drawn drawn = draw(torus(1, 0.4), viewFrom(0.7, elevation, false));
        const Checked checked = check(drawn, 150, 0.4);
        EXPECT_GT(checked.samples, 100);
        EXPECT_LE(checked.wrong, checked.samples / 500) << elevation;
    }
}

TEST(VisiblePieces, OfTwoTeapotsThatPassThroughEachOtherAgreeWithRaysOnTriangles) {
    auto patches = readPatches(kTeapot).patches;
    const auto other = mapped(patches, {{{0.6, -0.8, 0, 0.7}, {0.8, 0.6, 0, 0.4}, {0, 0, 1, 0.5}}});
    patches.insert(patches.end(), other.begin(), other.end());
    for (const double azimuth : {0.4, 2.9}) {
        const Checked checked = check(draw(patches, viewFrom(azimuth, 0.4, true)), 150, 0.4);
        EXPECT_GT(checked.samples, 1000);
        EXPECT_LE(checked.wrong, checked.samples / 500) << azimuth;
    }
}

// Distance of a place from the visible lines, but for the piece `except`.
double distanceFromSeen(const Drawn& drawn, std::size_t except, const CurvePoint& p) {
    double nearest = HUGE_VAL;
    for (std::size_t k = 0; k < drawn.pieces.size(); ++k) {
        if (k == except || drawn.pieces[k].hidden > 0) continue;
        const auto& points = drawn.pieces[k].curve.points;
        for (std::size_t i = 1; i < points.size(); ++i) {
            const CurvePoint &a = points[i - 1], &b = points[i];
            const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
            const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
            const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
            nearest = std::min(nearest, std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y));
        }
    }
    return nearest;
}

TEST(VisiblePieces, EndAtCuspsAndAtOtherVisibleLines) {
    const auto patches = readPatches(kTeapot).patches;
    std::array<int, 2> ends{}, loose{};  // of contours, and of all other lines
    for (int k = 0; k < 12; ++k) {
        const Drawn drawn = draw(patches, viewFrom(0.2 + k * 0.53, 0.1 + 0.1 * k, k % 2 == 0));
        for (std::size_t i = 0; i < drawn.pieces.size(); ++i) {
            const auto& [curve, hidden] = drawn.pieces[i];
            if (hidden > 0 || curve.closed) continue;
            const std::size_t kind = curve.kind == OutlineKind::Contour ? 0 : 1;
            for (const CurvePoint* end : {&curve.points.front(), &curve.points.back()}) {
                ++ends[kind];
                const bool hasReason =
                    end->corner || distanceFromSeen(drawn, i, *end) < 0.25 * drawn.pixel;
                if (!hasReason) ++loose[kind];
            }
        }
    }
    EXPECT_GT(ends[0], 150);
    EXPECT_GT(ends[1], 100);
    EXPECT_LE(loose[0], 1) << "of " << ends[0];
    // Where the handle's end grazes the body, an intersection may be found in part.
    EXPECT_LE(loose[1], ends[1] / 10) << "of " << ends[1];
}

TEST(VisiblePieces, OfASpiralThatHidesItselfAgreeWithRaysOnTriangles) {
    BsplineNet net{.degree = {3, 1}, .count = {16, 2}};
    for (int k = 0; k < 20; ++k) net.knots[0].push_back(k);
    net.knots[1] = {0, 0, 1, 1};
    for (int k = 0; k < 16; ++k) {
        const double radius = 0.3 + 0.12 * k, x = radius * std::cos(0.9 * k);
        for (const double z : {0.0, 1.8}) {
            net.control.push_back({x, radius * std::sin(0.9 * k), z, 1});
        }
    }
    const auto patches = bezierPatches(net);
    for (const double elevation : {0.1, 0.5, 1.1}) {
        const Checked checked = check(draw(patches, viewFrom(0.7, elevation, true)), 150, 0.4);
        EXPECT_GT(checked.samples, 500);
        EXPECT_LE(checked.wrong, checked.samples / 500) << elevation;
    }
}

TEST(VisiblePieces, AreWholeLoopsWhereAllIsSeen) {
    const Drawn drawn = draw(torus(1, 0.4), viewFrom(0.7, 1.2, false));
    ASSERT_EQ(drawn.pieces.size(), 2U);
    for (const VisiblePiece& piece : drawn.pieces) {
        EXPECT_TRUE(piece.curve.closed);
        EXPECT_EQ(piece.hidden, 0);
    }
}

}  // namespace
}  // namespace bandvox::outline_test

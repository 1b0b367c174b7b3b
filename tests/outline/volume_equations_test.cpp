// Intersections and isophotes of volumes against closed forms.

#include "outline/volumes/volume_equations.h"

#include "outline/drawn_distance.h"
#include "outline/volume_shapes.h"
#include "outline/volume_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::outline_test {
namespace {

using openvdb::Vec3d;

// A thousandth of the page's longer side.
constexpr double kPixel = 0.22;

const Vec3d kFirst(-0.3, 0.05, 0.02), kSecond(0.35, -0.1, 0.1);
constexpr double kRadius = 0.6;

std::vector<OutlineVolume> twoBalls() {
    return {
        {levelSet([](const Vec3d& p) { return ballDistance(p, kFirst, kRadius); }, plainLattice()),
         {},
         "first"},
        {levelSet([](const Vec3d& p) { return ballDistance(p, kSecond, kRadius); },
                  turnedLattice()),
         {},
         "second"}};
}

TEST(MeetingEquations, LieOnTheCircleOfTwoBalls) {
    const OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.3), false);
    const VolumeLines lines = linesOf(twoBalls(), options);
    int found = 0;
    for (const Curve& curve : lines.drawing->curves()) {
        if (curve.kind != OutlineKind::Intersection) continue;
        ++found;
        EXPECT_TRUE(curve.closed);
        const auto& grid = lines.drawing->surfaces()[0].object->grid();
        double length = 0;
        Vec3d last;
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const CurvePoint& p = curve.points[i];
            const Vec3d world = grid.indexToWorld(Vec3d(p.u, p.v, p.s));
            EXPECT_NEAR(ballDistance(world, kFirst, kRadius), 0, 2e-4);
            EXPECT_NEAR(ballDistance(world, kSecond, kRadius), 0, 2e-4);
            if (i > 0) length += (world - last).length();
            last = world;
        }
        const double half = 0.5 * (kSecond - kFirst).length();
        const double radius = std::sqrt(kRadius * kRadius - half * half);
        EXPECT_NEAR(length, 2 * std::numbers::pi * radius, 0.002);
    }
    EXPECT_EQ(found, 1);
}

TEST(MeetingEquations, LeaveNoEndWithoutAReason) {
    const InsideMaker inside = []() -> InsideFunction {
        return [](const Vec3d& p) {
            return -std::min(ballDistance(p, kFirst, kRadius), ballDistance(p, kSecond, kRadius));
        };
    };
    int samples = 0;
    for (const Vec3d& from : {Vec3d(0.2, -1, 0.3), Vec3d(1, 0.4, 0.5), Vec3d(-0.7, -0.6, 0.4)}) {
        for (const bool isPerspective : {false, true}) {
            const VolumeLines lines = linesOf(twoBalls(), fixedView(from, isPerspective));
            const Findings ends = checkEnds(lines.drawn);
            const Findings sight = checkVisibility(lines, inside, 3e-6);
            for (const Findings* findings : {&ends, &sight}) {
                for (const std::string& message : findings->messages) {
                    ADD_FAILURE() << from << ": " << message;
                }
            }
            samples += sight.samples;
        }
    }
    EXPECT_GT(samples, 500);
}

TEST(IsophoteEquations, AreCirclesOfABall) {
    OutlineOptions options = fixedView(Vec3d(0.3, -1, 0.2), false);
    options.light = Vec3d(0.5, 0.7, 0.6);
    options.isophotes = {-0.4, 0.3, 0.8};
    for (const auto& lattice : {plainLattice(), turnedLattice()}) {
        const auto grid =
            levelSet([](const Vec3d& p) { return ballDistance(p, Vec3d(0.0), 0.9); }, lattice);
        const VolumeLines lines = linesOf({{grid, {}, "ball"}}, options);
        const Camera camera(options.camera, 100, 100, openvdb::BBoxd(Vec3d(-1.0), Vec3d(1.0)));
        const Vec3d light =
            (options.light[0] * camera.right() + options.light[1] * camera.upward() -
             options.light[2] * camera.forward())
                .unit();
        std::vector<int> found(3, 0);
        for (const Curve& curve : lines.drawing->curves()) {
            if (curve.kind != OutlineKind::Isophote) continue;
            EXPECT_TRUE(curve.closed);
            const double cosine = curve.points[0].t;
            for (std::size_t k = 0; k < 3; ++k) found[k] += options.isophotes[k] == cosine ? 1 : 0;
            for (const CurvePoint& p : curve.points) {
                const Vec3d world = grid->indexToWorld(Vec3d(p.u, p.v, p.s));
                EXPECT_NEAR(world.unit().dot(light), cosine, 1e-3);
            }
        }
        EXPECT_EQ(found, std::vector<int>(3, 1));
        // They are cut where they go behind the ball: those ends lie on the contour.
        const PageCamera page(options);
        for (const VisiblePiece& piece : lines.drawn.pieces) {
            if (piece.curve.kind != OutlineKind::Isophote || piece.curve.closed) continue;
            for (const CurvePoint* end :
                 {&piece.curve.points.front(), &piece.curve.points.back()}) {
                const double away = page.fromContour({end->x, end->y}, [](const Vec3d& p) {
                    return ballDistance(p, Vec3d(0.0), 0.9);
                });
                EXPECT_LT(away, 0.1 * kPixel);
            }
        }
    }
}

}  // namespace
}  // namespace bandvox::outline_test

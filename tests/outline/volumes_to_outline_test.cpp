// Contours of volumes against closed forms.

#include "outline/drawn_distance.h"
#include "outline/sample_surfaces.h"
#include "outline/scenes.h"
#include "outline/volume_shapes.h"
#include "outline/volume_views.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/outline/volumes_to_outline.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::outline_test {
namespace {

using openvdb::Vec3d;

// A thousandth of the page's longer side.
constexpr double kPixel = 0.22;

struct Solid {
    std::string name;
    DistanceFunction distance;
};

double twoBallsDistance(const Vec3d& p) {
    return std::min(ballDistance(p, Vec3d(0.5, 0.35, 0.1), 0.42),
                    ballDistance(p, Vec3d(-0.5, -0.1, -0.1), 0.45));
}

std::vector<Solid> solids() {
    return {{"ball", [](const Vec3d& p) { return ballDistance(p, Vec3d(0.0), 0.9); }},
            {"torus", torusDistance},
            {"ellipsoid", ellipsoidDistance},
            {"two balls", twoBallsDistance}};
}

const std::vector<Vec3d> kDirections{{1, 0, 0}, {0.3, -1, 0.2}, {-0.6, 0.5, 0.8}};

OutlineVolume volumeOf(const openvdb::FloatGrid::Ptr& grid) {
    return {grid, {}, "volume"};
}

// Beyond the end of a cusp there is no contour, however near: so places around are asked, too.
double fromContour(const PageCamera& camera, const Place& p, const DistanceFunction& distance) {
    constexpr double kAside = 0.05 * kPixel;
    double nearest = camera.fromContour(p, distance);
    for (int k = 0; k < 8 && nearest > kAside; ++k) {
        const double angle = 0.25 * std::numbers::pi * k;
        const Place beside{p[0] + kAside * std::cos(angle), p[1] + kAside * std::sin(angle)};
        nearest = std::min(nearest, kAside + camera.fromContour(beside, distance));
    }
    return nearest;
}

double farthestFromContour(const Outline& outline, const OutlineOptions& options,
                           const DistanceFunction& distance) {
    const PageCamera camera(options);
    double worst = 0;
    for (const OutlinePath& path : outline.paths) {
        alongPath(path, 6, [&](const Place& p) {
            worst = std::max(worst, fromContour(camera, p, distance));
        });
    }
    return worst;
}

TEST(VolumesToOutline, KeepToTheTrueContoursWithinATenthOfAPixel) {
    for (const auto& lattice : {plainLattice(), turnedLattice()}) {
        for (const Solid& solid : solids()) {
            const auto grid = levelSet(solid.distance, lattice);
            for (const Vec3d& from : kDirections) {
                for (const bool isPerspective : {false, true}) {
                    const OutlineOptions options = fixedView(from, isPerspective);
                    const Outline outline = volumesToOutline({volumeOf(grid)}, {}, options);
                    EXPECT_LT(farthestFromContour(outline, options, solid.distance), 0.1 * kPixel)
                        << solid.name << " from " << from << (isPerspective ? ", near" : "");
                }
            }
        }
    }
}

TEST(VolumesToOutline, DrawABallAsOneClosedPathOfFewCubics) {
    const auto grid =
        levelSet([](const Vec3d& p) { return ballDistance(p, Vec3d(0.0), 0.9); }, plainLattice());
    for (const Vec3d& from : kDirections) {
        const Outline outline = volumesToOutline({volumeOf(grid)}, {}, fixedView(from, false));
        ASSERT_EQ(outline.paths.size(), 1U);
        EXPECT_TRUE(outline.paths[0].closed);
        EXPECT_EQ(outline.paths[0].hidden, 0);
        EXPECT_LE(outline.paths[0].anchors(), 8U);
    }
}

// Both contour points of each profile of the torus, seen in parallel.
std::vector<Vec3d> torusContour(const Vec3d& sight) {
    std::vector<Vec3d> points;
    for (int k = 0; k < 400; ++k) {
        const double u = 2 * std::numbers::pi * k / 400;
        const double across = std::cos(u) * sight[0] + std::sin(u) * sight[1];
        for (const double turn : {0.0, std::numbers::pi}) {
            const double v = std::atan2(-across, sight[2]) + turn;
            const double r = 0.7 + 0.3 * std::cos(v);
            points.emplace_back(r * std::cos(u), r * std::sin(u), 0.3 * std::sin(v));
        }
    }
    return points;
}

TEST(VolumesToOutline, DrawAllOfATorus) {
    const auto grid = levelSet(torusDistance, plainLattice());
    for (const Vec3d& from : {Vec3d(1, 0.2, 0.1), Vec3d(0.3, -1, 0.5), Vec3d(0.5, 0.4, 1.2)}) {
        const OutlineOptions options = fixedView(from, false);
        const Outline outline = volumesToOutline({volumeOf(grid)}, {}, options);
        ChainGrid drawn(options.width);
        for (const OutlinePath& path : outline.paths) {
            for (std::size_t piece = 0; 3 * piece + 3 < path.points.size(); ++piece) {
                for (int k = 0; k < 100; ++k) {
                    drawn.add(onCubic(path, piece, k / 100.0),
                              onCubic(path, piece, (k + 1) / 100.0));
                }
            }
        }
        const PageCamera camera(options);
        for (const Vec3d& p : torusContour(from)) {
            EXPECT_LT(drawn.distance(camera.place(p)), 0.1 * kPixel) << from << ": " << p;
        }
    }
}

TEST(VolumesToOutline, FindTheCuspsOfATorus) {
    const auto grid = levelSet(torusDistance, plainLattice());
    for (const auto& [elevation, cusps] : {std::pair{0.1, 4}, {0.4, 4}, {0.9, 0}, {1.4, 0}}) {
        for (int k = 0; k < 6; ++k) {
            const double azimuth = 2 * std::numbers::pi * (k + 0.1) / 6;
            const VolumeLines lines =
                linesOf({volumeOf(grid)}, viewFrom(azimuth, elevation, false));
            EXPECT_EQ(lines.drawing->curves().size(), 2U) << azimuth << ", " << elevation;
            EXPECT_EQ(openCurves(lines), 0);
            EXPECT_EQ(cuspsOf(lines), cusps) << azimuth << ", " << elevation;
        }
    }
}

TEST(VolumesToOutline, DrawTheBandLimitedDensityOfABall) {
    DensityOptions density;
    density.resolution = 64;
    const auto grid = surfaceToDensity(*makeShapeBoundary("shape:sphere"), density).grid;
    const double radius = ballSurface(32) / 32;
    for (const bool isPerspective : {false, true}) {
        const OutlineOptions options = fixedView(Vec3d(0.4, -0.3, 0.5), isPerspective);
        const Outline outline = volumesToOutline({volumeOf(grid)}, {}, options);
        ASSERT_EQ(outline.paths.size(), 1U);
        EXPECT_TRUE(outline.paths[0].closed);
        const auto distance = [&](const Vec3d& p) { return ballDistance(p, Vec3d(0.0), radius); };
        EXPECT_LT(farthestFromContour(outline, options, distance), 0.1 * kPixel);
    }
}

TEST(VolumesToOutline, HideWhatIsBehindByLinesOfSightThroughClosedForms) {
    int samples = 0;
    for (const Solid& solid : solids()) {
        const auto grid = levelSet(solid.distance, turnedLattice());
        const InsideMaker inside = [&]() -> InsideFunction {
            return [&](const Vec3d& p) { return -solid.distance(p); };
        };
        bool isPerspective = false;
        for (const double elevation : {-0.3, 0.2, 0.5}) {
            for (const double azimuth : {0.3, 1.9, 4.0}) {
                isPerspective = !isPerspective;
                const VolumeLines lines =
                    linesOf({volumeOf(grid)}, viewFrom(azimuth, elevation, isPerspective));
                // A thousandth of a voxel is what the lattice leaves unknown.
                const Findings sight = checkVisibility(lines, inside, 3e-5);
                const Findings ends = checkEnds(lines.drawn);
                EXPECT_EQ(openCurves(lines), 0);
                for (const Findings* findings : {&sight, &ends}) {
                    for (const std::string& message : findings->messages) {
                        ADD_FAILURE() << solid.name << " from " << azimuth << ", " << elevation
                                      << ": " << message;
                    }
                }
                samples += sight.samples;
            }
        }
    }
    EXPECT_GT(samples, 2000);
}

TEST(VolumesToOutline, CutTheLineOfABallBehindAnotherOneWhereItMeetsThat) {
    const Vec3d front(0.3, -0.6, 0), back(-0.2, 0.6, 0.1);
    const auto grid = levelSet(
        [&](const Vec3d& p) {
            return std::min(ballDistance(p, front, 0.4), ballDistance(p, back, 0.5));
        },
        plainLattice());
    const OutlineOptions options = fixedView(Vec3d(0, -1, 0), false);
    const Outline outline = volumesToOutline({volumeOf(grid)}, {}, options);
    ASSERT_EQ(outline.paths.size(), 3U);
    const PageCamera camera(options);
    const Place middle = camera.place(front);
    int closed = 0, seen = 0;
    for (const OutlinePath& path : outline.paths) {
        closed += path.closed ? 1 : 0;
        seen += path.hidden == 0 ? 1 : 0;
        EXPECT_EQ(path.hidden % 2, 0);
        if (path.closed) continue;
        for (const Place& end : {path.points.front(), path.points.back()}) {
            const double r = std::hypot(end[0] - middle[0], end[1] - middle[1]);
            EXPECT_NEAR(r, 0.4 * 200 / 2.8, 0.1 * kPixel);
        }
    }
    EXPECT_EQ(closed, 1);
    EXPECT_EQ(seen, 2);
}

TEST(VolumesToOutline, CloseTheLinesOfASurfaceThatTheDataCutOff) {
    auto grid = levelSet(torusDistance, plainLattice());
    // Nothing is known beyond a plane.
    openvdb::CoordBBox beyond = grid->evalActiveVoxelBoundingBox();
    beyond.expand(16);
    beyond.min()[0] = 7;
    grid->fill(beyond, grid->background(), false);
    grid->pruneGrid();
    for (const double azimuth : {0.3, 1.2, 3.0}) {
        const VolumeLines lines = linesOf({volumeOf(grid)}, viewFrom(azimuth, 0.4, false));
        EXPECT_GE(lines.drawing->curves().size(), 1U);
        EXPECT_EQ(openCurves(lines), 0) << azimuth;
        for (const std::string& message : checkEnds(lines.drawn).messages) {
            ADD_FAILURE() << azimuth << ": " << message;
        }
    }
}

TEST(VolumesToOutline, StandBesidePatches) {
    // A ball of patches behind one of a volume.
    PatchModel patches{
        mapped(sphere(0.5), {{{1, 0, 0, -0.2}, {0, 1, 0, 0.6}, {0, 0, 1, 0.1}}}), {"patches"}, {}};
    const auto grid = levelSet(
        [](const Vec3d& p) { return ballDistance(p, Vec3d(0.3, -0.6, 0), 0.4); }, plainLattice());
    const Outline outline =
        volumesToOutline({volumeOf(grid)}, patches, fixedView(Vec3d(0, -1, 0), false));
    ASSERT_EQ(outline.objects.size(), 2U);
    ASSERT_EQ(outline.paths.size(), 3U);
    for (const OutlinePath& path : outline.paths) {
        EXPECT_EQ(path.closed, path.object == 1);
        EXPECT_TRUE(path.hidden == 0 || path.object == 0);
    }
    // And the other way round.
    const Outline turned =
        volumesToOutline({volumeOf(grid)}, patches, fixedView(Vec3d(0, 1, 0), false));
    for (const OutlinePath& path : turned.paths) EXPECT_EQ(path.closed, path.object == 0);
}

TEST(VolumesToOutline, DoNotDependOnTheNumberOfThreads) {
    DensityOptions density;
    density.resolution = 96;
    const auto grid = surfaceToDensity(*makeShapeBoundary("shape:two-balls"), density).grid;
    std::vector<Outline> results;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        results.push_back(volumesToOutline({volumeOf(grid)}, {}, viewFrom(0.4, 0.5, true)));
    }
    ASSERT_EQ(results[0].paths.size(), results[1].paths.size());
    for (std::size_t k = 0; k < results[0].paths.size(); ++k) {
        EXPECT_EQ(results[0].paths[k].points, results[1].paths[k].points);
        EXPECT_EQ(results[0].paths[k].hidden, results[1].paths[k].hidden);
    }
}

TEST(VolumesToOutline, RefuseWhatCannotBeDrawn) {
    const auto statusOf = [](const OutlineVolume& volume, const OutlineOptions& options) {
        try {
            volumesToOutline({volume}, {}, options);
        } catch (const Error& error) {
            return error.exitStatus();
        }
        return 0;
    };
    const OutlineOptions options = fixedView(Vec3d(1, 0, 0), false);
    OutlineVolume volume = volumeOf(openvdb::FloatGrid::create(0));
    EXPECT_EQ(statusOf(volume, options), 4);
    volume = volumeOf(levelSet(torusDistance, plainLattice()));
    EXPECT_EQ(statusOf(volume, options), 0);
    volume.iso = -0.5;
    EXPECT_EQ(statusOf(volume, options), 4);
    volume.iso = 1;
    EXPECT_EQ(statusOf(volume, options), 2);
    volume.iso.reset();
    OutlineOptions inside = options;
    inside.camera.projection = CameraOptions::Projection::Perspective;
    inside.camera.eye = Vec3d(0.7, 0, 0);
    EXPECT_EQ(statusOf(volume, inside), 2);
    auto broken = levelSet(torusDistance, plainLattice());
    broken->tree().setValue(openvdb::Coord(22, 0, 0), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(statusOf(volumeOf(broken), options), 3);
    auto bent = levelSet(torusDistance, plainLattice());
    bent->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(0.0), Vec3d(10.0)), 0.5, 10, 1));
    EXPECT_EQ(statusOf(volumeOf(bent), options), 3);
}

}  // namespace
}  // namespace bandvox::outline_test

// Drawings of trimmed faces: where lines are, of which kind, and what hides them.

#include "cad/sample_parts.h"
#include "outline/drawing/draw_curves.h"
#include "outline/drawing/page_view.h"
#include "outline/drawing/visible_pieces.h"
#include "outline/patches/patch_scene.h"
#include "outline/patches/surface_curves.h"

#include <bandvox/outline/patches_to_outline.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace bandvox::cad_test {
namespace {

using openvdb::Vec3d;

OutlineOptions parallelView(const Vec3d& from, const Vec3d& up) {
    OutlineOptions options;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.from = from;
    options.camera.up = up;
    return options;
}

/// Lines before they are fitted, with places in the world.
struct SeenPart {
    PatchModel model;
    std::vector<VisiblePiece> pieces;

    Vec3d placeOf(const CurvePoint& p) const {
        const auto& patch = model.patches[static_cast<std::size_t>(p.patch)];
        return Vec3d(evaluate(patch, p.u, p.v).position.data());
    }
};

SeenPart draw(PatchModel model, const OutlineOptions& options) {
    SeenPart part{std::move(model), {}};
    const CurveSampling sampling = samplingFor(options);
    const ViewMatrix view = pageView(part.model.patches, options);
    const std::vector<ViewPatch> seen = seenBy(view, part.model.patches, sampling.size);
    const FaceRegions faces(part.model.topology);
    const LitPatches lit{part.model.patches, seen,
                         lightDirection(contentOf(part.model.patches), options), &faces};
    const auto curves = surfaceCurves(lit, options, sampling, silentProgress());
    part.pieces = visiblePieces(curves, PatchScene(lit, sampling.size), sampling, silentProgress());
    return part;
}

using Inside = std::function<bool(const Vec3d&)>;

bool isInDrilledBlock(const Vec3d& p) {
    const bool isInBlock = std::abs(p[0]) < 2 && std::abs(p[1]) < 3 && p[2] > 0 && p[2] < 1;
    return isInBlock && std::hypot(p[0] - 0.5, p[1]) > 1;
}

bool isInDrilledBall(const Vec3d& p) {
    return p.length() < 1 && std::hypot(p[0], p[1]) > 0.6;
}

bool isInCrossedCylinders(const Vec3d& p) {
    return std::hypot(p[0], p[1]) < 1 && std::hypot(p[1], p[2]) < 1;
}

// Goes from a line towards the eye in small steps, and compares what is drawn with whether solid is
// in between. What is as thin as a step, or grazed, is left out: there both answers come.
void compareWithSteps(const SeenPart& part, const Vec3d& toEye, const Inside& isInside,
                      int& samples, int& wrong) {
    constexpr double kStep = 2e-3, kBeside = 4e-3;
    const Vec3d eye = toEye.unit();
    Vec3d side = eye.cross(Vec3d(0.3, 0.5, 0.8)).unit();
    const Vec3d other = eye.cross(side);
    for (const VisiblePiece& piece : part.pieces) {
        const auto& points = piece.curve.points;
        for (std::size_t i = 3; i + 3 < points.size(); i += 3) {
            const Vec3d place = part.placeOf(points[i]);
            int hidden = 0, asked = 0;
            for (const Vec3d& off : {side, -side, other, -other}) {
                bool isHidden = false;
                for (double t = 10 * kStep; t < 8 && !isHidden; t += kStep) {
                    isHidden = isInside(place + kBeside * off + t * eye);
                }
                hidden += isHidden ? 1 : 0;
                ++asked;
            }
            if (hidden != 0 && hidden != asked) continue;
            ++samples;
            wrong += (piece.hidden > 0) != (hidden > 0) ? 1 : 0;
        }
    }
}

TEST(FacesToOutline, HidesWhatTheSolidHides) {
    const PartFolder folder;
    struct Solid {
        TopoDS_Shape shape;
        Inside inside;
    };
    const std::vector<Solid> solids{{drilledBlock(), isInDrilledBlock},
                                    {drilledBall(), isInDrilledBall},
                                    {crossedCylinders(), isInCrossedCylinders}};
    for (const Solid& solid : solids) {
        const PatchModel model = readPatches(folder.write(solid.shape, ".step"));
        int samples = 0, wrong = 0;
        for (int k = 0; k < 9; ++k) {
            const double azimuth = 0.7 * k + 0.1, height = 0.25 * (k % 4) + 0.2;
            const Vec3d from(std::cos(azimuth), std::sin(azimuth), height);
            compareWithSteps(draw(model, parallelView(from, {0, 0, 1})), from, solid.inside,
                             samples, wrong);
        }
        EXPECT_GT(samples, 200);
        EXPECT_EQ(wrong, 0) << "of " << samples;
    }
}

// From the axis a drilled block is three rectangles' sides and a circle, all on its faces' edges.
TEST(FacesToOutline, DrawsAHoleAsACircle) {
    const PartFolder folder;
    for (const char* const extension : {".step", ".iges", ".brep"}) {
        const PatchModel model = readPatches(folder.write(drilledBlock(), extension));
        const SeenPart part = draw(model, parallelView({0, 0, 1}, {0, 1, 0}));
        int onCircle = 0, onSides = 0;
        for (const VisiblePiece& piece : part.pieces) {
            if (piece.hidden > 0) continue;
            for (const CurvePoint& p : piece.curve.points) {
                const Vec3d place = part.placeOf(p);
                const double fromCircle = std::abs(std::hypot(place[0] - 0.5, place[1]) - 1);
                const double fromSides =
                    std::min(std::abs(std::abs(place[0]) - 2), std::abs(std::abs(place[1]) - 3));
                EXPECT_LT(std::min(fromCircle, fromSides), 1e-6) << extension;
                (fromCircle < 1e-6 ? onCircle : onSides) += 1;
            }
        }
        EXPECT_GT(onCircle, 20) << extension;
        EXPECT_GT(onSides, 8) << extension;
    }
}

// The contour of a cylinder from the side: two lines along its mantle, in the planes through the
// axis and across the line of sight, between its ends; and no patch's side within.
TEST(FacesToOutline, DrawsACylinderByTwoLinesAndItsEnds) {
    const PartFolder folder;
    const PatchModel model = readPatches(folder.write(cylinder(1, 3), ".step"));
    for (const double azimuth : {0.3, 1.1, 2.9, 4.4}) {
        const Vec3d from(std::cos(azimuth), std::sin(azimuth), 0.5);
        const SeenPart part = draw(model, parallelView(from, {0, 0, 1}));
        std::map<OutlineKind, double> lengths;
        for (const VisiblePiece& piece : part.pieces) {
            const auto& points = piece.curve.points;
            for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                const Vec3d a = part.placeOf(points[i]), b = part.placeOf(points[i + 1]);
                const double length = (a - b).length();
                const bool isOnMantle = std::abs(a[2] - b[2]) > 0.5 * length;
                if (isOnMantle && length > 1e-3) {
                    const double across = a[0] * std::cos(azimuth) + a[1] * std::sin(azimuth);
                    EXPECT_NEAR(across, 0, 1e-6);
                    EXPECT_EQ(piece.curve.kind, OutlineKind::Contour);
                }
                lengths[piece.curve.kind] += length;
            }
        }
        // Half of each end's edge is where the mantle turns away: a contour, too.
        const double circle = 2 * 3.14159265358979;
        EXPECT_NEAR(lengths[OutlineKind::Contour] + lengths[OutlineKind::Crease],
                    2 * 3 + 2 * circle, 2e-2);
        EXPECT_NEAR(lengths[OutlineKind::Crease], circle, 1e-2);
        EXPECT_EQ(lengths.count(OutlineKind::Boundary), 0U);
        EXPECT_EQ(lengths.count(OutlineKind::Intersection), 0U);
    }
}

// A part drawn as faces, and another one through it.
TEST(FacesToOutline, CutsIntersectionsToBothParts) {
    const PartFolder folder;
    PatchModel scene = readPatches(folder.write(drilledBlock(), ".brep"));
    scene.append(readPatches(folder.write(cylinder(0.5, 3, {0.5, 2, -1}), ".brep")));
    const SeenPart part = draw(scene, parallelView({1, 2, 1.5}, {0, 0, 1}));
    double length = 0;
    for (const VisiblePiece& piece : part.pieces) {
        if (piece.curve.kind != OutlineKind::Intersection) continue;
        const auto& points = piece.curve.points;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const Vec3d a = part.placeOf(points[i]), b = part.placeOf(points[i + 1]);
            EXPECT_NEAR(std::hypot(a[0] - 0.5, a[1] - 2), 0.5, 1e-6);
            length += (a - b).length();
        }
    }
    // The cylinder passes through the top and the bottom, and meets neither the hole nor a side.
    EXPECT_NEAR(length, 2 * 3.14159265358979, 1e-2);
}

TEST(FacesToOutline, DrawsAnOpenFaceByItsBoundary) {
    const PartFolder folder;
    const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1, 0.2, 0.9).Shape();
    // The zone alone, without its caps.
    PatchModel model = readPatches(folder.write(ball, ".brep"));
    const SeenPart whole = draw(model, parallelView({1, 0.4, 0.6}, {0, 0, 1}));
    for (const VisiblePiece& piece : whole.pieces) {
        EXPECT_NE(piece.curve.kind, OutlineKind::Boundary);
    }
    for (FaceEdge& edge : model.topology.edges) {
        if (edge.uses.size() == 2 && edge.uses[0].face != edge.uses[1].face) edge.uses.pop_back();
    }
    const SeenPart open = draw(model, parallelView({1, 0.4, 0.6}, {0, 0, 1}));
    double length = 0;
    for (const VisiblePiece& piece : open.pieces) {
        if (piece.curve.kind != OutlineKind::Boundary) continue;
        const auto& points = piece.curve.points;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            length += (open.placeOf(points[i]) - open.placeOf(points[i + 1])).length();
        }
    }
    EXPECT_NEAR(length, 2 * 3.14159265358979 * (std::cos(0.2) + std::cos(0.9)), 1e-2);
}

TEST(FacesToOutline, GivesTheSameWhateverTheFile) {
    const PartFolder folder;
    const OutlineOptions options = parallelView({1, -2, 1}, {0, 0, 1});
    const Outline step =
        patchesToOutline(readPatches(folder.write(crossedCylinders(), ".step")), options);
    const Outline brep =
        patchesToOutline(readPatches(folder.write(crossedCylinders(), ".brep")), options);
    ASSERT_EQ(step.paths.size(), brep.paths.size());
    const auto visible = [](const Outline& outline) {
        return std::count_if(outline.paths.begin(), outline.paths.end(),
                             [](const OutlinePath& path) { return path.hidden == 0; });
    };
    EXPECT_GT(visible(step), 0);
    EXPECT_EQ(visible(step), visible(brep));
}

TEST(FacesToOutline, FillsPartsInTones) {
    const PartFolder folder;
    OutlineOptions options = parallelView({1, -2, 1}, {0, 0, 1});
    options.fill = OutlineFillKind::Toon;
    const Outline outline =
        patchesToOutline(readPatches(folder.write(drilledBlock(), ".step")), options);
    EXPECT_GT(outline.fills.size(), 2U);
}

}  // namespace
}  // namespace bandvox::cad_test

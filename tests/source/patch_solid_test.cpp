#include "source/test_patches.h"

#include <bandvox/core/error.h>
#include <bandvox/source/patch_solid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Patches = std::vector<BezierPatch>;

constexpr double kPi = std::numbers::pi;

Patches together(const Patches& a, const Patches& b) {
    Patches all = a;
    all.insert(all.end(), b.begin(), b.end());
    return all;
}

ErrorKind kindOf(const Patches& patches, const PatchSolidOptions& options = {}) {
    try {
        makePatchSolid("test", patches, options);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::Interrupted;
}

TEST(PatchSolid, MeasuresARationalSphere) {
    const PatchSolid solid = makePatchSolid("ball", spherePatches(Vec3d(0.3, -0.2, 0.1), 0.7));
    EXPECT_EQ(solid.report.pieces, 1);
    EXPECT_TRUE(solid.report.warnings.empty());
    EXPECT_NEAR(solid.source->volume(), 4 * kPi / 3 * 0.343, 1e-11);
    EXPECT_NEAR(solid.source->area(), 4 * kPi * 0.49, 1e-7);
    const openvdb::BBoxd box = solid.source->bounds();
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(box.extents()[axis], 1.4, 1e-6);
}

TEST(PatchSolid, TurnsFlippedPatchesAndWholeSurfaces) {
    Patches some = spherePatches(Vec3d(0), 1);
    some[1] = turnedOver(some[1]);
    some[6] = turnedOver(some[6]);
    const PatchSolid mended = makePatchSolid("ball", some);
    EXPECT_EQ(mended.report.patchesFlipped, 2);
    EXPECT_NEAR(mended.source->volume(), 4 * kPi / 3, 1e-10);

    Patches all = spherePatches(Vec3d(0), 1);
    for (BezierPatch& patch : all) patch = turnedOver(patch);
    const PatchSolid turned = makePatchSolid("ball", all);
    EXPECT_EQ(turned.report.piecesTurned, 1);
    EXPECT_NEAR(turned.source->volume(), 4 * kPi / 3, 1e-10);
}

TEST(PatchSolid, ClosesACylinderByDiscs) {
    const PatchSolid solid = makePatchSolid("tube", cylinderPatches(0.5, 2));
    ASSERT_EQ(solid.report.holes.size(), 2);
    EXPECT_EQ(solid.report.holes[0].edges, 4);
    EXPECT_NEAR(solid.report.holes[0].perimeter, kPi, 1e-3);
    ASSERT_EQ(solid.report.warnings.size(), 1);
    EXPECT_NE(solid.report.warnings[0].find("2 holes capped (largest: 4 edges"), std::string::npos);
    EXPECT_NEAR(solid.source->volume(), kPi / 2, 1e-10);
    EXPECT_NEAR(solid.source->area(), 2 * kPi + kPi / 2, 1e-7);
}

TEST(PatchSolid, CountsWhereBallsOverlapOnce) {
    const Patches two =
        together(spherePatches(Vec3d(0), 1), spherePatches(Vec3d(0.9, 0.3, 0.2), 0.8));
    const double d = Vec3d(0.9, 0.3, 0.2).length();
    const double both = 4 * kPi / 3 * (1 + 0.512);
    // The lens of two balls.
    const double lens =
        kPi * std::pow(1.8 - d, 2) * (d * d + 2 * d * 1.8 - 3 * std::pow(1 - 0.8, 2)) / (12 * d);
    EXPECT_NEAR(makePatchSolid("sum", two, {.unite = false}).source->volume(), both, 1e-10);
    const PatchSolid united = makePatchSolid("union", two);
    EXPECT_EQ(united.report.piecesMeeting, 2);
    EXPECT_NEAR(united.source->volume(), both - lens, 1e-5);
}

TEST(PatchSolid, CountsFacesThatLieOnEachOtherNotAtAll) {
    // A cylinder on a wider one: the discs between them have their middles in the same place.
    Patches upper = cylinderPatches(0.6, 0.5);
    for (BezierPatch& patch : upper) {
        for (auto& p : patch.control) p[2] += 2 * p[3];
    }
    const PatchSolid solid = makePatchSolid("tower", together(cylinderPatches(1, 2), upper));
    EXPECT_EQ(solid.report.piecesMeeting, 2);
    EXPECT_NEAR(solid.source->volume(), kPi * (2 + 0.18), 1e-4);
    EXPECT_NEAR(solid.source->area(), kPi * (2 + 4 + 0.6), 2e-3);
}

TEST(PatchSolid, LeavesOutWhatIsInsideAndKeepsCavities) {
    const Patches outer = spherePatches(Vec3d(0), 1);
    Patches inner = spherePatches(Vec3d(0.2, 0, 0), 0.5);
    EXPECT_NEAR(makePatchSolid("nested", together(outer, inner)).source->volume(), 4 * kPi / 3,
                1e-5);
    for (BezierPatch& patch : inner) patch = turnedOver(patch);
    const PatchSolid hollow = makePatchSolid("hollow", together(outer, inner));
    EXPECT_EQ(hollow.report.piecesTurned, 0);
    EXPECT_NEAR(hollow.source->volume(), 4 * kPi / 3 * (1 - 0.125), 1e-5);
}

TEST(PatchSolid, StandsAHeightFieldOnItsBase) {
    // z = 1 + x y over the unit square.
    BezierPatch top{.degreeU = 1,
                    .degreeV = 1,
                    .control = {{0, 0, 1, 1}, {0, 1, 1, 1}, {1, 0, 1, 1}, {1, 1, 2, 1}}};
    for (const BezierPatch& patch : {top, turnedOver(top)}) {
        const PatchSolid solid = makePatchSolid("field", {patch}, {.base = 0.0});
        EXPECT_NEAR(solid.source->volume(), 1.25, 1e-12);
        EXPECT_TRUE(solid.report.holes.empty());
    }
    EXPECT_EQ(kindOf({top}, {.base = 1.5}), ErrorKind::Usage);
    // A bowl that goes down to a quarter of what its middle control point does.
    BezierPatch bowl{.degreeU = 2, .degreeV = 2};
    for (int i = 0; i <= 2; ++i) {
        for (int j = 0; j <= 2; ++j) {
            bowl.control.push_back({0.5 * i, 0.5 * j, i == 1 && j == 1 ? -1.0 : 0.0, 1});
        }
    }
    const PatchSolid above = makePatchSolid("bowl", {bowl}, {.base = -0.3});
    EXPECT_NEAR(above.source->volume(), 0.3 - 1.0 / 9, 1e-9);
    EXPECT_EQ(kindOf({bowl}, {.base = -0.24}), ErrorKind::Usage);
    EXPECT_EQ(kindOf(spherePatches(Vec3d(0), 1), {.base = -2.0}), ErrorKind::Usage);
    EXPECT_EQ(kindOf(cylinderPatches(0.5, 2), {.base = -2.0}), ErrorKind::Usage);
}

TEST(PatchSolid, RefusesWhatHasNoInside) {
    EXPECT_EQ(kindOf({}), ErrorKind::Input);
    EXPECT_EQ(kindOf(stripPatches(1)), ErrorKind::Result);  // Möbius
    BezierPatch flat{.degreeU = 1,
                     .degreeV = 1,
                     .control = {{0, 0, 1, 1}, {0, 1, 1, 1}, {1, 0, 1, 1}, {1, 1, 1, 1}}};
    EXPECT_EQ(kindOf({flat}), ErrorKind::Result);
    EXPECT_EQ(kindOf(spherePatches(Vec3d(0), 1), {.joinTolerance = -1}), ErrorKind::Usage);
    // The same strip without a twist has two sides.
    EXPECT_EQ(makePatchSolid("ring", stripPatches(0)).report.pieces, 1);
}

}  // namespace
}  // namespace bandvox

// Where a side with known passages through a plane passes through it.

#include "outline/patches/meeting_sides.h"

#include "outline/patches/bernstein.h"
#include "outline/patches/view_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bandvox {
namespace {

// The patch (u, v, h(u) + v), h having these roots.
BezierPatch waved(const std::vector<double>& roots) {
    Bernstein2 height(0, 0);
    height.c[0] = 4;
    for (const double root : roots) {
        Bernstein2 factor(1, 0);
        factor.c = {-root, 1 - root};
        height = height * factor;
    }
    BezierPatch patch{.degreeU = height.m, .degreeV = 1};
    for (int i = 0; i <= height.m; ++i) {
        for (int j = 0; j <= 1; ++j) {
            patch.control.push_back({double(i) / height.m, double(j), height.at(i, 0) + j, 1});
        }
    }
    return patch;
}

TEST(SidePassages, HasEachPassageInAPartOfItsOwn) {
    const ViewMatrix view{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    const std::vector<double> roots{0.3, 0.31, 0.7, 0.7004};
    BezierPatch plane{.degreeU = 1, .degreeV = 1};
    plane.control = {{-1, -1, 0, 1}, {-1, 2, 0, 1}, {2, -1, 0, 1}, {2, 2, 0, 1}};
    const PatchCell wave = cellOf(seenBy(view, waved(roots), 1), 0);
    const PatchCell flat = cellOf(seenBy(view, plane, 1), 1);
    const auto passages = sidePassages(wave, 2, flat, 1e-6);
    for (const double root : roots) {
        bool isFound = false;
        for (const SidePassage& passage : passages) {
            const double reach = 0.5 * passage.sizeA * (1 + 1e-9);
            const double s = (root + 1) / 3, t = 1.0 / 3, reachB = 0.5 * passage.sizeB * (1 + 1e-9);
            isFound |= std::abs(passage.along - root) <= reach &&
                       std::abs(passage.s - s) <= reachB && std::abs(passage.t - t) <= reachB;
        }
        EXPECT_TRUE(isFound) << root;
    }
    for (const SidePassage& passage : passages) {
        int inside = 0;
        for (const double root : roots) {
            inside += std::abs(root - passage.along) < 0.5 * passage.sizeA ? 1 : 0;
        }
        EXPECT_LE(inside, 1) << passage.along;
    }
    // The opposite side lies above the plane.
    EXPECT_TRUE(sidePassages(wave, 3, flat, 1e-6).empty());
}

}  // namespace
}  // namespace bandvox

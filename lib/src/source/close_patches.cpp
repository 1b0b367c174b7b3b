#include "source/close_patches.h"

#include "core/words.h"
#include "source/free_form_patch.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Curve = std::vector<std::array<double, 4>>;

/// The ruled patch from one curve to another of the same weights, with the first on its left.
BezierPatch ruled(const Curve& from, const Curve& to) {
    BezierPatch patch{.degreeU = static_cast<int>(from.size()) - 1, .degreeV = 1};
    // A side's surface is on its left, and what closes it on its right.
    for (std::size_t k = from.size(); k-- > 0;) {
        patch.control.push_back(from[k]);
        patch.control.push_back(to[k]);
    }
    return patch;
}

Curve pointOf(const Curve& curve, const Vec3d& apex) {
    Curve to;
    for (const auto& p : curve)
        to.push_back({apex[0] * p[3], apex[1] * p[3], apex[2] * p[3], p[3]});
    return to;
}

Curve onPlane(const Curve& curve, double z) {
    Curve to = curve;
    for (auto& p : to) p[2] = z * p[3];
    return to;
}

/// Its length and mean point, by chords.
CappedHole holeOf(const std::vector<OpenSide>& loop) {
    constexpr int kChords = 64;
    CappedHole hole{.edges = loop.size(), .perimeter = 0, .center = Vec3d(0)};
    for (const OpenSide& side : loop) {
        Vec3d last = curvePoint(side.control, 0);
        for (int k = 1; k <= kChords; ++k) {
            const Vec3d next = curvePoint(side.control, static_cast<double>(k) / kChords);
            const double length = (next - last).length();
            hole.perimeter += length;
            hole.center += 0.5 * length * (last + next);
            last = next;
        }
    }
    hole.center /= hole.perimeter;
    return hole;
}

[[noreturn]] void refuseBase(const std::string& found) {
    throw Error(ErrorKind::Usage, "a base needs a height field, and the surface " + found +
                                      "; expected one piece with one border, of which no part "
                                      "lies above another");
}

/// Whether all of a surface is seen from above: 1, from below: -1. Told at points.
int sideUp(const std::vector<BezierPatch>& patches) {
    constexpr int kSteps = 8;
    bool up = false, down = false;
    for (const BezierPatch& patch : patches) {
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; j <= kSteps; ++j) {
                const PatchJet p = evaluate(patch, i / double{kSteps}, j / double{kSteps});
                const double z = p.du[0] * p.dv[1] - p.du[1] * p.dv[0];
                up = up || z > 0;
                down = down || z < 0;
            }
        }
    }
    if (up == down) refuseBase("turns over");
    return up ? 1 : -1;
}

}  // namespace

std::vector<CappedHole> capLoops(std::vector<BezierPatch>& patches, JoinedPatches& joined) {
    std::vector<CappedHole> holes;
    for (const auto& loop : findLoops(joined.open)) {
        const CappedHole hole = holeOf(loop);
        for (const OpenSide& side : loop) {
            patches.push_back(ruled(side.control, pointOf(side.control, hole.center)));
            joined.ofPatch.push_back(side.component);
        }
        holes.push_back(hole);
    }
    std::stable_sort(holes.begin(), holes.end(), [](const CappedHole& a, const CappedHole& b) {
        return a.perimeter > b.perimeter;
    });
    joined.open.clear();
    return holes;
}

void standOnBase(std::vector<BezierPatch>& patches, JoinedPatches& joined, double base) {
    if (joined.components != 1) {
        refuseBase("has " + std::to_string(joined.components) + " pieces");
    }
    auto loops = findLoops(joined.open);
    if (loops.size() != 1) refuseBase("has " + counted(loops.size(), "border", "borders"));
    if (sideUp(patches) < 0) {
        for (BezierPatch& patch : patches) patch = turned(patch);
        for (OpenSide& side : loops[0]) std::reverse(side.control.begin(), side.control.end());
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (const BezierPatch& patch : patches) {
        for (const auto& p : patch.control) lowest = std::min(lowest, p[2] / p[3]);
    }
    if (!(lowest > base)) {
        // The surface may not go down as far as its control points.
        const std::vector<FreeFormPatch> surface(patches.begin(), patches.end());
        constexpr double kNear = 1e-9;
        lowest = tightBounds(surface, kNear * std::max(1.0, std::abs(base))).min()[2];
    }
    if (!(lowest > base)) {
        throw Error(ErrorKind::Usage, "the base at " + inFull(base) +
                                          " is not below the surface, which goes down to " +
                                          inFull(lowest) + "; expected a lower one");
    }
    Vec3d center = holeOf(loops[0]).center;
    center[2] = base;
    for (const OpenSide& side : loops[0]) {
        const Curve foot = onPlane(side.control, base);
        patches.push_back(ruled(side.control, foot));
        patches.push_back(ruled(foot, pointOf(foot, center)));
    }
    joined.ofPatch.assign(patches.size(), 0);
    joined.open.clear();
}

}  // namespace bandvox

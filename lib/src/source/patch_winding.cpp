#include "source/patch_winding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Point = std::array<double, 4>;

/// The direction of rays, which no face or seam of a model is likely to be parallel to, and what
/// is at right angles to it.
const Vec3d kAxis = Vec3d(0.5317, 0.2913, 0.7951).unit();
const Vec3d kAcross = kAxis.cross(Vec3d(0.6113, -0.7717, 0.1759)).unit();
const Vec3d kUp = kAxis.cross(kAcross);

/// How far Jacobians of a part may be from their mean, times its inverse, in the 1-norm. The middle
/// one's inverse times any other is then off from 1 by at most twice that over 1 less that, and a
/// root half a side away along both axes is at most 1 plus that away by Newton's first step.
constexpr double kMostTurning = 0.25;
constexpr double kFarthestStep = 1 + 2 * kMostTurning / (1 - kMostTurning);

/// Halvings of a part: before it is stored, and while a ray is followed.
constexpr int kStoredHalvings = 6;
constexpr int kRayHalvings = 40;

Vec3d inFrame(const Vec3d& p) {
    return {kAxis.dot(p), kAcross.dot(p), kUp.dot(p)};
}

openvdb::BBoxd hullOf(const BezierPatch& patch) {
    openvdb::BBoxd box;
    for (const Point& p : patch.control) box.expand(Vec3d(p[0], p[1], p[2]) / p[3]);
    return box;
}

std::array<BezierPatch, 4> quartersOf(const BezierPatch& p) {
    return {restricted(p, 0, 0.5, 0, 0.5), restricted(p, 0.5, 1, 0, 0.5),
            restricted(p, 0, 0.5, 0.5, 1), restricted(p, 0.5, 1, 0.5, 1)};
}

/// Two polynomials, which are zero together where a part is met by the line through a point.
struct LineSystem {
    const FreeFormPatch& surface;
    Vec3d origin;  ///< in the frame
    const BezierPatch& part = surface.patch();

    /// w times the distances across and up from the line.
    std::array<double, 2> at(const Point& p) const {
        return {p[1] - origin[1] * p[3], p[2] - origin[2] * p[3]};
    }

    bool hasNoRoot() const {
        bool below[3]{}, above[3]{};
        for (const Point& p : part.control) {
            const auto [f, g] = at(p);
            const double ahead = p[0] - origin[0] * p[3];
            below[0] |= f <= 0;
            above[0] |= f >= 0;
            below[1] |= g <= 0;
            above[1] |= g >= 0;
            above[2] |= ahead >= 0;
        }
        return !(below[0] && above[0] && below[1] && above[1] && above[2]);
    }

    /// True if the map is one to one on the part: Jacobians everywhere are near their mean, so that
    /// the mean's inverse times them is dominated by its diagonal.
    bool isOneToOne() const {
        double mean[2][2]{};
        visitSlopes([&](int parameter, const std::array<double, 2>& slope, double share) {
            mean[0][parameter] += share * slope[0];
            mean[1][parameter] += share * slope[1];
        });
        const double determinant = mean[0][0] * mean[1][1] - mean[0][1] * mean[1][0];
        const double scale = std::abs(mean[0][0] * mean[1][1]) + std::abs(mean[0][1] * mean[1][0]);
        if (!(std::abs(determinant) > 1e-9 * scale)) return false;
        double farthest[2]{};
        visitSlopes([&](int parameter, const std::array<double, 2>& slope, double) {
            const double x = (mean[1][1] * slope[0] - mean[0][1] * slope[1]) / determinant;
            const double y = (mean[0][0] * slope[1] - mean[1][0] * slope[0]) / determinant;
            const double off =
                std::abs(x - (parameter == 0 ? 1 : 0)) + std::abs(y - (parameter == 0 ? 0 : 1));
            farthest[parameter] = std::max(farthest[parameter], off);
        });
        return std::max(farthest[0], farthest[1]) < kMostTurning;
    }

    /// The crossing of the ray, with its sign, where there is one at most; nothing if Newton's
    /// method does not find it out. `isBounded`: kFarthestStep holds.
    std::optional<int> crossing(bool isBounded) const {
        double u = 0.5, v = 0.5;
        constexpr int kMostSteps = 30;
        constexpr double kLost = 1.0;
        constexpr double kStep = 1e-14;
        for (int step = 0; step < kMostSteps; ++step) {
            const PatchPoint jet = surface.at(u, v);
            const double determinant = jet.du[1] * jet.dv[2] - jet.du[2] * jet.dv[1];
            const double f = jet.position[1] - origin[1];
            const double g = jet.position[2] - origin[2];
            const double du = -(jet.dv[2] * f - jet.dv[1] * g) / determinant;
            const double dv = -(jet.du[1] * g - jet.du[2] * f) / determinant;
            if (!std::isfinite(du) || !std::isfinite(dv)) return {};
            if (isBounded && step == 0 && std::abs(du) + std::abs(dv) > kFarthestStep) return 0;
            u += du;
            v += dv;
            if (std::abs(du) + std::abs(dv) < kStep || step + 1 == kMostSteps) {
                if (std::abs(du) + std::abs(dv) > 1e-9) return {};
                const bool isInside = u >= 0 && u < 1 && v >= 0 && v < 1;
                if (!isInside || jet.position[0] <= origin[0]) return 0;
                return determinant > 0 ? 1 : -1;
            }
            if (std::abs(u - 0.5) > 0.5 + kLost || std::abs(v - 0.5) > 0.5 + kLost) return {};
        }
        return {};
    }

  private:
    template <typename Visit>
    void visitSlopes(const Visit& visit) const {
        const int n = part.degreeU;
        const int m = part.degreeV;
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= m; ++j) {
                const auto here = at(part.at(i, j));
                const auto go = [&](int k, int l, int parameter, int degree, double count) {
                    const auto next = at(part.at(k, l));
                    visit(parameter,
                          std::array{degree * (next[0] - here[0]), degree * (next[1] - here[1])},
                          1 / count);
                };
                if (i < n) go(i + 1, j, 0, n, static_cast<double>(n) * (m + 1));
                if (j < m) go(i, j + 1, 1, m, static_cast<double>(m) * (n + 1));
            }
        }
    }
};

int crossings(const FreeFormPatch& surface, const Vec3d& origin, int depth, bool isOneToOne) {
    const LineSystem system{surface, origin};
    if (system.hasNoRoot()) return 0;
    if (isOneToOne || system.isOneToOne()) {
        if (const auto found = system.crossing(isOneToOne)) return *found;
    }
    if (depth == kRayHalvings) return 0;
    int sum = 0;
    for (const BezierPatch& quarter : quartersOf(surface.patch())) {
        sum += crossings(FreeFormPatch(quarter), origin, depth + 1, false);
    }
    return sum;
}

// Without weights the map is one to one on a part whatever the ray, or not.
bool isPolynomial(const BezierPatch& patch) {
    return std::all_of(patch.control.begin(), patch.control.end(),
                       [](const Point& p) { return p[3] == 1; });
}

}  // namespace

// Cuts a part until rays meet it once at most, or for some times if it is seen from its edge.
void PatchWinding::store(const BezierPatch& patch, double size, int depth) {
    FreeFormPatch part(patch);
    const openvdb::BBoxd hull = hullOf(patch);
    const bool isOneToOne = LineSystem{part, hull.getCenter()}.isOneToOne();
    const bool isSmall = hull.extents().length() <= size;
    if (depth == kStoredHalvings || (isSmall && isOneToOne)) {
        mParts.push_back({std::move(part), isOneToOne && isPolynomial(patch)});
        return;
    }
    for (const BezierPatch& quarter : quartersOf(patch)) store(quarter, size, depth + 1);
}

PatchWinding::PatchWinding(const std::vector<const BezierPatch*>& patches,
                           const openvdb::BBoxd& bounds, double size)
    : mBounds(bounds) {
    for (const BezierPatch* patch : patches) {
        BezierPatch inRays = *patch;
        for (Point& p : inRays.control) {
            const Vec3d turned = inFrame({p[0], p[1], p[2]});
            p = {turned[0], turned[1], turned[2], p[3]};
        }
        store(inRays, size, 0);
    }
    std::vector<openvdb::BBoxd> hulls, boxes;
    for (const Part& part : mParts) {
        const BezierPatch& patch = part.surface.patch();
        hulls.push_back(hullOf(patch));
        openvdb::BBoxd& box = boxes.emplace_back();
        for (const Point& p : patch.control) {
            box.expand((p[0] * kAxis + p[1] * kAcross + p[2] * kUp) / p[3]);
        }
    }
    mTree = std::make_unique<BoxTree>(std::move(hulls));
    mWorldTree = std::make_unique<BoxTree>(std::move(boxes));
}

int PatchWinding::at(const Vec3d& point) const {
    if (!mBounds.isInside(point)) return 0;
    const Vec3d origin = inFrame(point);
    int sum = 0;
    mTree->visitAlongX(origin, [&](std::uint32_t i) {
        sum += crossings(mParts[i].surface, origin, 0, mParts[i].isOneToOne);
    });
    return sum;
}

bool PatchWinding::mayMeet(const openvdb::BBoxd& box) const {
    bool meets = false;
    mWorldTree->visitMeeting(box, [&](std::uint32_t) { meets = true; });
    return meets;
}

}  // namespace bandvox

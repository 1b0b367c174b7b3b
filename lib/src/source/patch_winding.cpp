#include "source/patch_winding.h"

#include "source/bernstein_basis.h"

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

/// How far Jacobians of a part may be from their mean, times its inverse, in the 1-norm. The
/// inverse of one times any other is then off from 1 by at most q, and a root in the part is no
/// farther from where Newton's method starts than 1 / (1 - q) of its step, and from where that ends
/// than q / (1 - q) of it.
constexpr double kMostTurning = 0.25;
constexpr double kInverseTurning = 2 * kMostTurning / (1 - kMostTurning);
constexpr double kRootFromStart = 1 / (1 - kInverseTurning);
constexpr double kRootFromStep = kInverseTurning / (1 - kInverseTurning);

/// Halvings of a part: before it is stored, and while a ray is followed.
constexpr int kStoredHalvings = 12;
constexpr int kRayHalvings = 80;

Vec3d inFrame(const Vec3d& p) {
    return {kAxis.dot(p), kAcross.dot(p), kUp.dot(p)};
}

openvdb::BBoxd hullOf(const PatchWinding::Part& part) {
    openvdb::BBoxd box;
    for (const Point& p : part.net) box.expand(Vec3d(p[0], p[1], p[2]) / p[3]);
    return box;
}

Vec3d inWorld(const Point& p) {
    return (p[0] * kAxis + p[1] * kAcross + p[2] * kUp) / p[3];
}

/// Control points by their places in a net.
struct NetSteps {
    int degreeU, degreeV;

    /// Calls visit(from, to, parameter, degree) for neighbours along u, parameter 0, and v, 1.
    template <typename Visit>
    void visit(const Visit& visit) const {
        const auto row = static_cast<std::size_t>(degreeV) + 1;
        std::size_t k = 0;
        for (int i = 0; i <= degreeU; ++i) {
            for (int j = 0; j <= degreeV; ++j, ++k) {
                if (i < degreeU) visit(k, k + row, 0, degreeU);
                if (j < degreeV) visit(k, k + 1, 1, degreeV);
            }
        }
    }
};

/// Makes a part its half along its longer side, and returns the other one. Parts beside a point
/// that a side has collapsed to stay wide as they are, and get shorter.
PatchWinding::Part halve(PatchWinding::Part& part) {
    double longest[2]{};
    NetSteps{part.degreeU, part.degreeV}.visit(
        [&](std::size_t from, std::size_t to, int parameter, int degree) {
            const Point &a = part.net[from], &b = part.net[to];
            double square = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double step = b[c] / b[3] - a[c] / a[3];
                square += step * step;
            }
            longest[parameter] = std::max(longest[parameter], degree * degree * square);
        });
    PatchWinding::Part high{part.degreeU, part.degreeV,
                            halveNet(part.net, part.degreeU, part.degreeV, longest[0] > longest[1]),
                            part.isPolynomial};
    return high;
}

using RayJet = PatchWinding::RayJet;

RayJet jetAt(const PatchWinding::Part& part, double u, double v) {
    const BernsteinBasis a(part.degreeU, u), b(part.degreeV, v);
    Point s{}, su{}, sv{};
    const Point* p = part.net.begin();
    for (int i = 0; i <= part.degreeU; ++i) {
        Point row{}, slope{};
        for (int j = 0; j <= part.degreeV; ++j, ++p) {
            const double value = b.value(j), rise = b.slope(j);
            for (std::size_t c = 0; c < 4; ++c) {
                row[c] += value * (*p)[c];
                slope[c] += rise * (*p)[c];
            }
        }
        const double value = a.value(i), rise = a.slope(i);
        for (std::size_t c = 0; c < 4; ++c) {
            s[c] += value * row[c];
            su[c] += rise * row[c];
            sv[c] += value * slope[c];
        }
    }
    RayJet jet;
    const double scale = 1 / s[3];
    for (std::size_t c = 0; c < 3; ++c) {
        jet.position[c] = s[c] * scale;
        jet.du[c] = (su[c] - su[3] * jet.position[c]) * scale;
        jet.dv[c] = (sv[c] - sv[3] * jet.position[c]) * scale;
    }
    return jet;
}

// Along the ray, by a parameter, of a part without weights.
double largestSlopeOf(const PatchWinding::Part& part) {
    double largest = 0;
    NetSteps{part.degreeU, part.degreeV}.visit(
        [&](std::size_t from, std::size_t to, int, int degree) {
            largest = std::max(largest, degree * std::abs(part.net[to][0] - part.net[from][0]));
        });
    return largest;
}

/// Two polynomials, which are zero together where a part is met by the line through a point.
struct LineSystem {
    const PatchWinding::Part& part;
    Vec3d origin;  ///< in the frame

    /// w times the distances across and up from the line.
    std::array<double, 2> at(const Point& p) const {
        return {p[1] - origin[1] * p[3], p[2] - origin[2] * p[3]};
    }

    bool hasNoRoot() const {
        bool below[3]{}, above[3]{};
        for (const Point& p : part.net) {
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
    /// method does not find it out.
    std::optional<int> crossing() const {
        double u = 0.5, v = 0.5, before = HUGE_VAL;
        for (int step = 0; step < kMostSteps; ++step) {
            const RayJet jet = jetAt(part, u, v);
            const NewtonStep by = newtonStep(jet);
            if (!std::isfinite(by.du) || !std::isfinite(by.dv)) return {};
            u += by.du;
            v += by.dv;
            if (isAtRest(by.length(), before)) return signAt(jet, u, v);
            before = by.length();
            if (!isWithin(u, kLost) || !isWithin(v, kLost)) return {};
        }
        return {};
    }

    /// The same of a part without weights that is one to one, by the jet at its middle and the
    /// largest slope along the ray. A step tells how far from its end the root is
    /// at most, so that few are needed where that is clearly in the part and ahead, or is not.
    std::optional<int> quickCrossing(RayJet jet, double largestSlope) const {
        double u = 0.5, v = 0.5, before = HUGE_VAL;
        for (int step = 0; step < kMostSteps; ++step) {
            const NewtonStep by = newtonStep(jet);
            if (!std::isfinite(by.du) || !std::isfinite(by.dv)) return {};
            const bool isBounded = isWithin(u, kBeside) && isWithin(v, kBeside);
            const double farthest = std::max(u, 1 - u) + std::max(v, 1 - v);
            u += by.du;
            v += by.dv;
            if (isAtRest(by.length(), before)) return signAt(jet, u, v);
            before = by.length();
            if (isBounded) {
                const double reach = kRootFromStep * by.length();
                if (by.length() > (1 + kInverseTurning) * farthest) return 0;
                if (!isWithin(u, reach) || !isWithin(v, reach)) return 0;
                const double ahead = jet.position[0] - origin[0];
                if (std::abs(ahead) > kRootFromStart * by.length() * largestSlope) {
                    if (ahead < 0) return 0;
                    if (isWithin(u, -reach) && isWithin(v, -reach)) {
                        return by.determinant > 0 ? 1 : -1;
                    }
                }
            }
            if (!isWithin(u, kLost) || !isWithin(v, kLost)) return {};
            jet = jetAt(part, u, v);
        }
        return {};
    }

  private:
    // Each step squares the error, until of a small part rounding is all that is left.
    static bool isAtRest(double step, double before) {
        constexpr double kNear = 1e-10, kSmall = 1e-3;
        return step < kNear || (step < kSmall && step > 0.5 * before);
    }
    static constexpr int kMostSteps = 30;
    // Slopes are bounded in the part; beyond its sides by so much they hardly differ.
    static constexpr double kBeside = 1e-3;
    static constexpr double kLost = 1.0;  // beyond its sides

    static bool isWithin(double t, double beside) { return t >= -beside && t <= 1 + beside; }

    struct NewtonStep {
        double du, dv, determinant;
        double length() const { return std::abs(du) + std::abs(dv); }
    };

    NewtonStep newtonStep(const RayJet& jet) const {
        const double determinant = jet.du[1] * jet.dv[2] - jet.du[2] * jet.dv[1];
        const double f = jet.position[1] - origin[1];
        const double g = jet.position[2] - origin[2];
        return {-(jet.dv[2] * f - jet.dv[1] * g) / determinant,
                -(jet.du[1] * g - jet.du[2] * f) / determinant, determinant};
    }

    // Sides belong to one of the parts that they lie between.
    int signAt(const RayJet& jet, double u, double v) const {
        const bool isInside = u >= 0 && u < 1 && v >= 0 && v < 1;
        if (!isInside || jet.position[0] <= origin[0]) return 0;
        return jet.du[1] * jet.dv[2] > jet.du[2] * jet.dv[1] ? 1 : -1;
    }

    template <typename Visit>
    void visitSlopes(const Visit& visit) const {
        const int n = part.degreeU, m = part.degreeV;
        const double shares[2]{1.0 / (n * (m + 1)), 1.0 / (m * (n + 1))};
        NetSteps{n, m}.visit([&](std::size_t from, std::size_t to, int parameter, int degree) {
            const auto here = at(part.net[from]), next = at(part.net[to]);
            visit(parameter, std::array{degree * (next[0] - here[0]), degree * (next[1] - here[1])},
                  shares[parameter]);
        });
    }
};

int crossings(const PatchWinding::Part& part, const Vec3d& origin, int depth) {
    const LineSystem system{part, origin};
    if (system.hasNoRoot()) return 0;
    std::optional<int> found;
    if (part.isOneToOne) {
        found = system.quickCrossing(part.middle, part.largestSlope);
    } else if (system.isOneToOne()) {
        found = part.isPolynomial
                    ? system.quickCrossing(jetAt(part, 0.5, 0.5), largestSlopeOf(part))
                    : system.crossing();
    }
    if (found) return *found;
    if (depth == kRayHalvings) return 0;
    PatchWinding::Part low = part;
    low.isOneToOne = false;
    const PatchWinding::Part high = halve(low);
    return crossings(low, origin, depth + 1) + crossings(high, origin, depth + 1);
}

// Whether a part may be in a box of the world, as well as parts tell that are as small as the box.
bool mayBeIn(const openvdb::BBoxd& box, const PatchWinding::Part& part, int depth) {
    openvdb::BBoxd hull;
    for (const Point& p : part.net) hull.expand(inWorld(p));
    if (!hull.hasOverlap(box)) return false;
    constexpr int kMostHalvings = 16;
    if (depth == kMostHalvings || hull.extents().length() <= box.extents().length()) return true;
    PatchWinding::Part low = part;
    const PatchWinding::Part high = halve(low);
    return mayBeIn(box, low, depth + 1) || mayBeIn(box, high, depth + 1);
}

}  // namespace

// Cuts a part until rays meet it once at most, or for some times if it is seen from its edge.
void PatchWinding::store(Part part, double size, int depth) {
    const openvdb::BBoxd hull = hullOf(part);
    const bool isOneToOne = LineSystem{part, hull.getCenter()}.isOneToOne();
    const bool isSmall = hull.extents().length() <= size;
    if (depth == kStoredHalvings || (isSmall && isOneToOne)) {
        part.isOneToOne = isOneToOne && part.isPolynomial;
        part.middle = jetAt(part, 0.5, 0.5);
        part.largestSlope = largestSlopeOf(part);
        mParts.push_back(std::move(part));
        return;
    }
    Part high = halve(part);
    store(std::move(part), size, depth + 1);
    store(std::move(high), size, depth + 1);
}

PatchWinding::PatchWinding(const std::vector<const BezierPatch*>& patches,
                           const openvdb::BBoxd& bounds, double size)
    : mBounds(bounds) {
    for (const BezierPatch* patch : patches) {
        Part part{patch->degreeU, patch->degreeV, ControlNet<4>(patch->control.size())};
        std::transform(patch->control.begin(), patch->control.end(), part.net.begin(),
                       [](const Point& p) {
                           const Vec3d turned = inFrame({p[0], p[1], p[2]});
                           return Point{turned[0], turned[1], turned[2], p[3]};
                       });
        // Then the map is one to one on a part whatever the ray, or not.
        part.isPolynomial =
            std::all_of(part.net.begin(), part.net.end(), [](const Point& p) { return p[3] == 1; });
        store(std::move(part), size, 0);
    }
    std::vector<openvdb::BBoxd> hulls, boxes;
    for (const Part& part : mParts) {
        hulls.push_back(hullOf(part));
        openvdb::BBoxd& box = boxes.emplace_back();
        for (const Point& p : part.net) box.expand(inWorld(p));
    }
    mTree = std::make_unique<BoxTree>(std::move(hulls));
    mWorldTree = std::make_unique<BoxTree>(std::move(boxes));
}

int PatchWinding::at(const Vec3d& point) const {
    if (!mBounds.isInside(point)) return 0;
    const Vec3d origin = inFrame(point);
    int sum = 0;
    mTree->visitAlongX(origin, [&](std::uint32_t i) { sum += crossings(mParts[i], origin, 0); });
    return sum;
}

bool PatchWinding::mayMeet(const openvdb::BBoxd& box) const {
    bool meets = false;
    mWorldTree->visitMeeting(box,
                             [&](std::uint32_t i) { meets = meets || mayBeIn(box, mParts[i], 0); });
    return meets;
}

}  // namespace bandvox

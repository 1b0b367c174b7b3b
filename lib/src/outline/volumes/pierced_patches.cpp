#include "outline/volumes/pierced_patches.h"

#include "outline/drawing/join_curves.h"
#include "outline/patches/face_cuts.h"
#include "outline/patches/onto_zero.h"
#include "source/control_net.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

constexpr double kCell = 0.5;   // largest side of a cell, voxels
constexpr int kFinest = 13;     // halvings of a patch at most
constexpr int kPartsLevel = 3;  // halvings to the parts whose speed is bounded
// Densities are read in single precision.
constexpr double kRounding = 1e-6;

/// A part of a patch in index coordinates.
struct PatchBlock {
    ControlNet<4> points;
    int level = 0;
    std::int64_t i = 0, j = 0;  // of the parts of that level along u and v
};

/// Where a curve passes an edge of the lattice of parameters: the lower one of its ends, and
/// whether it goes along u.
using EdgeKey = std::array<std::int64_t, 3>;

/// Follows the curves on one patch.
class PatchPiercing {
  public:
    PatchPiercing(const LitPatches& lit, int patch, const VolumeSurface& surface,
                  const CurveSampling& sampling)
        : mPatch(lit.patches[static_cast<std::size_t>(patch)]),
          mNumber(patch),
          mBlocks(surface.object->blocks()),
          mFinder(lit, surface),
          mSampling(sampling),
          mObject(lit.seen[static_cast<std::size_t>(patch)].object) {
        const auto& grid = surface.object->grid();
        const openvdb::Mat4d toIndex =
            grid.transform().baseMap()->getAffineMap()->getMat4().inverse();
        mWhole.points.resize(mPatch.control.size());
        for (std::size_t k = 0; k < mPatch.control.size(); ++k) {
            for (int c = 0; c < 4; ++c) {
                double sum = 0;
                for (int r = 0; r < 4; ++r) {
                    sum += mPatch.control[k][static_cast<std::size_t>(r)] * toIndex(r, c);
                }
                mWhole.points[k][static_cast<std::size_t>(c)] = sum;
            }
        }
    }

    std::vector<Curve> follow() {
        mLevel = levelOf(mWhole.points);
        visit(mWhole);
        return chains();
    }

  private:
    static Vec3d placeOf(const ControlNet<4>::Point& p) { return Vec3d(p[0], p[1], p[2]) / p[3]; }

    // How often to halve until no side of a cell is too long.
    int levelOf(const ControlNet<4>& points) const {
        const double halvings = std::ceil(std::log2(std::max(fastest(points, 0) / kCell, 1.0)));
        return std::clamp(static_cast<int>(halvings), kPartsLevel, kFinest);
    }

    // A bound of the derivatives by the whole patch's parameters. M. S. Floater, "Derivatives of
    // rational Bézier curves", 1992: the degree times the largest step between control points,
    // times the square of the ratio of weights. Of parts of the patch that is nearly 1.
    double fastest(ControlNet<4> points, int level) const {
        if (level < kPartsLevel) {
            ControlNet<4> high = halveNet(points, mPatch.degreeU, mPatch.degreeV, true);
            double result = 0;
            for (ControlNet<4>* half : {&points, &high}) {
                const ControlNet<4> other = halveNet(*half, mPatch.degreeU, mPatch.degreeV, false);
                result = std::max({result, fastest(*half, level + 1), fastest(other, level + 1)});
            }
            return result;
        }
        double longest = 0, least = points[0][3], most = least;
        for (int i = 0; i <= mPatch.degreeU; ++i) {
            for (int j = 0; j <= mPatch.degreeV; ++j) {
                const auto& point = points[mPatch.index(i, j)];
                least = std::min(least, point[3]);
                most = std::max(most, point[3]);
                const Vec3d p = placeOf(point);
                const auto compare = [&](std::size_t next, int degree) {
                    longest = std::max(longest, degree * (placeOf(points[next]) - p).length());
                };
                if (i < mPatch.degreeU) compare(mPatch.index(i + 1, j), mPatch.degreeU);
                if (j < mPatch.degreeV) compare(mPatch.index(i, j + 1), mPatch.degreeV);
            }
        }
        const double ratio = most / least;
        return std::ldexp(longest * ratio * ratio, level);
    }

    // False if the part is far from the solid.
    bool mayPierce(const PatchBlock& block) const {
        openvdb::BBoxd box;
        for (const auto& p : block.points) box.expand(placeOf(p));
        return mBlocks.touches(box);
    }

    void visit(const PatchBlock& block) {
        if (!mayPierce(block)) return;
        if (block.level == mLevel) return search(block.i, block.j);
        PatchBlock low = block;
        PatchBlock high{halveNet(low.points, mPatch.degreeU, mPatch.degreeV, true)};
        for (PatchBlock* half : {&low, &high}) {
            PatchBlock other{halveNet(half->points, mPatch.degreeU, mPatch.degreeV, false)};
            PatchBlock* const quarters[] = {half, &other};
            for (int k = 0; k < 2; ++k) {
                quarters[k]->level = block.level + 1;
                quarters[k]->i = 2 * block.i + (half == &high ? 1 : 0);
                quarters[k]->j = 2 * block.j + k;
                visit(*quarters[k]);
            }
        }
    }

    double parameter(std::int64_t i) const { return std::ldexp(static_cast<double>(i), -mLevel); }

    double valueAt(std::int64_t i, std::int64_t j) {
        const auto key = static_cast<std::uint64_t>(i) << 32U | static_cast<std::uint64_t>(j);
        const auto [found, isNew] = mValues.try_emplace(key, 0.0);
        if (isNew) found->second = mFinder.at(mNumber, parameter(i), parameter(j)).value;
        return found->second;
    }

    // Notes which edges of a cell the curve joins.
    void search(std::int64_t i, std::int64_t j) {
        const std::array<std::array<std::int64_t, 2>, 4> corners{
            {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
        const std::array<EdgeKey, 4> edges{{{i, j, 1}, {i + 1, j, 0}, {i, j + 1, 1}, {i, j, 0}}};
        std::array<bool, 4> isInside{};
        for (std::size_t k = 0; k < 4; ++k)
            isInside[k] = valueAt(corners[k][0], corners[k][1]) >= 0;
        std::vector<EdgeKey> passed;
        for (std::size_t k = 0; k < 4; ++k) {
            if (isInside[k] != isInside[(k + 1) % 4]) passed.push_back(edges[k]);
        }
        if (passed.empty()) return;
        if (passed.size() == 4) {
            const double half = 0.5 * parameter(1);
            const bool isMiddleInside =
                mFinder.at(mNumber, parameter(i) + half, parameter(j) + half).value >= 0;
            // Corners that the middle is not like are cut off, each from the next edge to its own.
            if (isInside[0] != isMiddleInside) {
                std::rotate(passed.begin(), passed.begin() + 1, passed.end());
            }
            link(passed[2], passed[3]);
        }
        link(passed[0], passed[1]);
    }

    void link(const EdgeKey& a, const EdgeKey& b) {
        mLinks[a].push_back(b);
        mLinks[b].push_back(a);
    }

    // The root on an edge, within the bracket of its ends.
    CurvePoint pointOn(const EdgeKey& edge) {
        const auto [i, j, alongU] = edge;
        double low = 0, high = parameter(1);
        const double u0 = parameter(i), v0 = parameter(j);
        const auto gradientAt = [&, isU = alongU == 1](double t) {
            const Gradient2 g = mFinder.at(mNumber, u0 + (isU ? t : 0), v0 + (isU ? 0 : t));
            return std::pair(g.value, isU ? g.du : g.dv);
        };
        const bool isLowInside = valueAt(i, j) >= 0;
        double t = 0.5 * high;
        for (int step = 0; step < 60 && high - low > 1e-15; ++step) {
            const auto [value, slope] = gradientAt(t);
            ((value >= 0) == isLowInside ? low : high) = t;
            double next = t - value / slope;
            const bool isThere = std::abs(next - t) < 1e-13;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (isThere) break;
            t = next;
        }
        return alongU == 1 ? mFinder.seen(mNumber, u0 + t, v0) : mFinder.seen(mNumber, u0, v0 + t);
    }

    std::vector<Curve> chains() {
        std::vector<Curve> curves;
        // Those with ends at the patch's border first; what is left is closed.
        for (const bool closed : {false, true}) {
            for (auto& [edge, links] : mLinks) {
                if (links.empty() || (!closed && links.size() != 1)) continue;
                curves.push_back(chainFrom(edge, closed));
            }
        }
        return curves;
    }

    Curve chainFrom(EdgeKey edge, bool closed) {
        Curve curve{.kind = OutlineKind::Intersection, .closed = closed, .object = mObject};
        CurvePoint last = pointOn(edge);
        curve.points.push_back(last);
        for (auto* links = &mLinks.at(edge); !links->empty(); links = &mLinks.at(edge)) {
            const EdgeKey next = links->back();
            links->pop_back();
            auto& back = mLinks.at(next);
            back.erase(std::find(back.begin(), back.end(), edge));
            edge = next;
            const CurvePoint point = pointOn(edge);
            refine(last, point, 0, curve.points);
            last = point;
        }
        return curve;
    }

    // Appends the points after a, up to b.
    void refine(const CurvePoint& a, const CurvePoint& b, int depth,
                std::vector<CurvePoint>& points) {
        constexpr int kMostHalvings = 12;
        constexpr double kBow = 1.3, kSmallTurn = 0.98;
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const bool isFlat = bowBetween(a, b) < kBow * mSampling.flatness &&
                            std::abs(a.tx * b.tx + a.ty * b.ty) > kSmallTurn;
        if (isFlat || depth == kMostHalvings || length < 0.01 * mSampling.flatness) {
            points.push_back(b);
            return;
        }
        const CurvePoint middle = mFinder.between(a, b, 0.5);
        refine(a, middle, depth + 1, points);
        refine(middle, b, depth + 1, points);
    }

    const BezierPatch& mPatch;
    int mNumber;
    const SurfaceBlocks& mBlocks;
    PiercingFinder mFinder;
    const CurveSampling& mSampling;
    int mObject;
    PatchBlock mWhole;
    int mLevel = 0;
    std::unordered_map<std::uint64_t, double> mValues;  // of nodes
    std::map<EdgeKey, std::vector<EdgeKey>> mLinks;     // that are still to be followed
};

}  // namespace

PiercingFinder::PiercingFinder(const LitPatches& lit, const VolumeSurface& surface)
    : mLit(lit),
      mSurface(surface),
      mProbe(surface.object->probe()),
      mToIndex(surface.object->grid().transform().baseMap()->getAffineMap()->getMat4().inverse()) {}

Gradient2 PiercingFinder::at(int patch, double u, double v) {
    const PatchJet jet = evaluate(mLit.patches[static_cast<std::size_t>(patch)], u, v);
    const auto vector = [](const std::array<double, 3>& a) { return Vec3d(a[0], a[1], a[2]); };
    const DensityAt density = mProbe->evaluate(mToIndex.transform(vector(jet.position)));
    // Rows are vectors: directions come from the left.
    const openvdb::Mat3d turn = mToIndex.getMat3();
    return {density.value - mSurface.object->threshold(),
            density.gradient.dot(vector(jet.du) * turn),
            density.gradient.dot(vector(jet.dv) * turn)};
}

CurvePoint PiercingFinder::seen(int patch, double u, double v) {
    const ViewPoint p = mLit.seen[static_cast<std::size_t>(patch)].at(u, v);
    CurvePoint point{.x = p.x, .y = p.y, .z = p.z};
    const Gradient2 g = at(patch, u, v);
    const double tx = p.xv * g.du - p.xu * g.dv, ty = p.yv * g.du - p.yu * g.dv;
    const double length = std::hypot(tx, ty);
    if (length > 0) {
        point.tx = tx / length;
        point.ty = ty / length;
    }
    point.patch = patch;
    point.u = u;
    point.v = v;
    point.other = mSurface.index;
    point.rule = CurveRule::Piercing;
    return point;
}

CurvePoint PiercingFinder::between(const CurvePoint& a, const CurvePoint& b, double share) {
    double u = a.u + share * (b.u - a.u), v = a.v + share * (b.v - a.v);
    const auto functionAt = [&](double x, double y) { return at(a.patch, x, y); };
    if (!ontoZero(functionAt, u, v, kRounding)) return share < 0.5 ? a : b;
    return seen(a.patch, u, v);
}

std::vector<Curve> piercingCurves(const LitPatches& lit, const VolumeSurface& surface,
                                  const CurveSampling& sampling, Progress& progress) {
    std::vector<std::vector<Curve>> perPatch(lit.patches.size());
    parallelFor(static_cast<std::int64_t>(perPatch.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        std::vector<Curve> found =
            PatchPiercing(lit, static_cast<int>(i), surface, sampling).follow();
        if (lit.faces && lit.faces->isTrimmed(static_cast<int>(i))) {
            PiercingFinder finder(lit, surface);
            const PointBetween between = [&](const CurvePoint& a, const CurvePoint& b, double s) {
                return finder.between(a, b, s);
            };
            found = cutToFaces(std::move(found), lit.faces, between);
        }
        perPatch[static_cast<std::size_t>(i)] = std::move(found);
    });
    std::vector<Curve> curves;
    for (auto& some : perPatch) std::move(some.begin(), some.end(), std::back_inserter(curves));
    return joinCurves(std::move(curves), sampling);
}

}  // namespace bandvox

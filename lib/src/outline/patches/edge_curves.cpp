#include "outline/patches/edge_curves.h"

#include "outline/patches/line_sampler.h"
#include "outline/patches/vectors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bandvox {
namespace {

constexpr double kOnEdge = 1e-7;  // of parameters: a fold that ends so near ends there

// The number of the piece that has a parameter of the edge.
std::size_t pieceAt(const EdgeUse& use, double t) {
    std::size_t k = 0;
    while (k + 1 < use.pieces.size() && use.pieces[k].to <= t) ++k;
    return k;
}

std::array<double, 2> placeAt(const EdgePiece& piece, double t) {
    return jetAt(piece.curve, (t - piece.from) / (piece.to - piece.from)).place;
}

CurvePoint onPiece(const LitPatches& lit, int number, double s) {
    const EdgePiece& piece = lit.faces->piece(number);
    const ParameterJet jet = jetAt(piece.curve, s);
    const ViewPoint p =
        lit.seen[static_cast<std::size_t>(piece.patch)].at(jet.place[0], jet.place[1]);
    double tx = p.xu * jet.slope[0] + p.xv * jet.slope[1];
    double ty = p.yu * jet.slope[0] + p.yv * jet.slope[1];
    const double length = std::hypot(tx, ty);
    tx = length > 0 ? tx / length : 1;
    ty = length > 0 ? ty / length : 0;
    return {.x = p.x,
            .y = p.y,
            .z = p.z,
            .tx = tx,
            .ty = ty,
            .patch = piece.patch,
            .u = jet.place[0],
            .v = jet.place[1],
            .other = number,
            .s = s,
            .rule = CurveRule::Edge};
}

// Where a curve is nearest to a place, if that is as good as on it.
bool isOnCurve(const ParameterCurve& curve, double u, double v, double& share) {
    ParameterBox box = boxOf(curve);
    for (std::size_t c = 0; c < 2; ++c) {
        const double x = c == 0 ? u : v;
        if (x < box.low[c] - kOnEdge || x > box.high[c] + kOnEdge) return false;
    }
    // Newton's method from the best of a few places.
    constexpr int kStarts = 8;
    double best = 1e300;
    for (int k = 0; k <= kStarts; ++k) {
        const double t = static_cast<double>(k) / kStarts;
        const auto p = jetAt(curve, t).place;
        const double away = std::hypot(p[0] - u, p[1] - v);
        if (away >= best) continue;
        best = away;
        share = t;
    }
    for (int step = 0; step < 20; ++step) {
        const ParameterJet jet = jetAt(curve, share);
        const double square = jet.slope[0] * jet.slope[0] + jet.slope[1] * jet.slope[1];
        if (!(square > 0)) break;
        const double move =
            ((u - jet.place[0]) * jet.slope[0] + (v - jet.place[1]) * jet.slope[1]) / square;
        share = std::clamp(share + move, 0.0, 1.0);
        if (std::abs(move) < 1e-14) break;
    }
    const auto p = jetAt(curve, share).place;
    return std::hypot(p[0] - u, p[1] - v) < kOnEdge;
}

class EdgeWork {
  public:
    EdgeWork(const LitPatches& lit, const CurveSampling& sampling)
        : mLit(lit), mSampling(sampling), mOnPatch(lit.seen.size()) {
        int number = 0;
        const auto& edges = topology().edges;
        mBreaks.resize(edges.size());
        for (std::size_t e = 0; e < edges.size(); ++e) {
            for (const EdgeUse& use : edges[e].uses) {
                mFirst.push_back(number);
                for (const EdgePiece& piece : use.pieces) {
                    mOnPatch[static_cast<std::size_t>(piece.patch)].push_back({number++, e});
                }
            }
        }
    }

    void breakAt(std::span<const Curve> folds) {
        for (const Curve& fold : folds) {
            if (fold.closed || fold.points.empty()) continue;
            for (const CurvePoint* p : {&fold.points.front(), &fold.points.back()}) {
                for (const OnPatch& on : mOnPatch[static_cast<std::size_t>(p->patch)]) {
                    const EdgePiece& piece = mLit.faces->piece(on.piece);
                    double share = 0;
                    if (!isOnCurve(piece.curve, p->u, p->v, share)) continue;
                    mBreaks[on.edge].push_back(piece.from + share * (piece.to - piece.from));
                }
            }
        }
    }

    BorderCurves work(double crease) {
        BorderCurves curves;
        std::size_t firstUse = 0;
        const auto& edges = topology().edges;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const FaceEdge& edge = edges[e];
            const Range whole{0, 1};
            if (edge.uses.size() == 1) {
                sample(edge.uses[0], mFirst[firstUse], whole, OutlineKind::Boundary,
                       curves.boundaries);
            } else if (edge.uses.size() > 2) {
                sample(edge.uses[0], mFirst[firstUse], whole, OutlineKind::Crease, curves.creases);
            } else if (edge.uses.size() == 2) {
                workShared(e, firstUse, crease, curves);
            }
            firstUse += edge.uses.size();
        }
        return curves;
    }

  private:
    struct OnPatch {
        int piece;
        std::size_t edge;
    };
    struct Range {
        double from, to;
    };

    const FaceTopology& topology() const { return mLit.faces->topology(); }

    // How the surface turns to the eye there: F, and that relative to lengths.
    struct Facing {
        double sign, steepness;
        bool canFold;
    };
    Facing facingAt(const EdgeUse& use, double t) const {
        const EdgePiece& piece = use.pieces[pieceAt(use, t)];
        const auto [u, v] = placeAt(piece, t);
        const ViewPatch& seen = mLit.seen[static_cast<std::size_t>(piece.patch)];
        const ViewPoint p = seen.at(u, v);
        const double lengths = std::hypot(p.xu, p.yu, p.zu) * std::hypot(p.xv, p.yv, p.zv) + 1e-300;
        const double area = p.xu * p.yv - p.xv * p.yu;
        return {evaluate(seen.f, u, v).value, std::abs(area) / lengths, seen.hasFold};
    }

    Vec normalAt(const EdgeUse& use, double t) const {
        const EdgePiece& piece = use.pieces[pieceAt(use, t)];
        const auto [u, v] = placeAt(piece, t);
        const PatchJet jet = evaluate(mLit.patches[static_cast<std::size_t>(piece.patch)], u, v);
        const Vec n = cross(jet.du, jet.dv);
        const double length = lengthOf(n);
        return length > 0 ? times(1 / length, n) : Vec{};
    }

    bool isCrease(const FaceEdge& edge, double orientation, double crease) const {
        for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
            const Vec a = normalAt(edge.uses[0], t), b = normalAt(edge.uses[1], t);
            const bool isKnown = lengthOf(a) * lengthOf(b) > 0.5;
            if (isKnown && dot(a, b) * orientation < crease) return true;
        }
        return false;
    }

    void workShared(std::size_t e, std::size_t firstUse, double crease, BorderCurves& curves) {
        const FaceEdge& edge = topology().edges[e];
        const EdgeUse &a = edge.uses[0], &b = edge.uses[1];
        const double orientation = a.isReversed != b.isReversed ? 1 : -1;
        const bool isSharp = isCrease(edge, orientation, crease);
        std::vector<double> breaks{0, 1};
        breaks.insert(breaks.end(), mBreaks[e].begin(), mBreaks[e].end());
        std::sort(breaks.begin(), breaks.end());
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
            const Range range{breaks[i], breaks[i + 1]};
            if (!(range.from < range.to)) continue;
            const double t = 0.5 * (range.from + range.to);
            const Facing onA = facingAt(a, t), onB = facingAt(b, t);
            const bool isContour =
                onA.canFold && onB.canFold && onA.sign * onB.sign * orientation < 0;
            if (!isContour && !isSharp) continue;
            // Where a face is seen nearly edge-on, what is not quite on it is far off in depth.
            const bool isA = onA.steepness <= onB.steepness;
            sample(isA ? a : b, mFirst[firstUse + (isA ? 0 : 1)], range,
                   isContour ? OutlineKind::Contour : OutlineKind::Crease,
                   isContour ? curves.contours : curves.creases);
        }
    }

    void sample(const EdgeUse& use, int first, const Range& range, OutlineKind kind,
                std::vector<Curve>& curves) const {
        for (std::size_t k = 0; k < use.pieces.size(); ++k) {
            const EdgePiece& piece = use.pieces[k];
            const double length = piece.to - piece.from;
            if (!(length > 0)) continue;
            const double from = std::max(0.0, (range.from - piece.from) / length);
            const double to = std::min(1.0, (range.to - piece.from) / length);
            if (!(from < to)) continue;
            const auto at = [&](double s) { return onPiece(mLit, first + static_cast<int>(k), s); };
            Curve curve{.kind = kind,
                        .object = mLit.seen[static_cast<std::size_t>(piece.patch)].object};
            curve.points.push_back(at(from));
            LineSampler(at, mSampling)
                .refine({from, to}, curve.points.front(), at(to), 0, curve.points);
            curves.push_back(std::move(curve));
        }
    }

    const LitPatches& mLit;
    const CurveSampling& mSampling;
    std::vector<std::vector<OnPatch>> mOnPatch;
    std::vector<int> mFirst;                   // piece of each use, of all edges one after another
    std::vector<std::vector<double>> mBreaks;  // of edges
};

}  // namespace

BorderCurves edgeCurves(const LitPatches& lit, std::span<const Curve> folds, double crease,
                        const CurveSampling& sampling) {
    if (!lit.faces) return {};
    EdgeWork work(lit, sampling);
    work.breakAt(folds);
    return work.work(crease);
}

EdgeFaces facesAt(const LitPatches& lit, const CurvePoint& point) {
    const EdgePiece& own = lit.faces->piece(point.other);
    const double t = own.from + point.s * (own.to - own.from);
    EdgeFaces result;
    for (const EdgeUse& use : lit.faces->edgeOf(point.other).uses) {
        result.faces.push_back(use.face);
        if (use.pieces.empty()) continue;
        const EdgePiece& piece = use.pieces[pieceAt(use, t)];
        const auto [u, v] = placeAt(piece, t);
        const ViewPoint p = lit.seen[static_cast<std::size_t>(piece.patch)].at(u, v);
        result.gap = std::max(result.gap, std::hypot(p.x - point.x, p.y - point.y, p.z - point.z));
    }
    return result;
}

CurvePoint edgeBetween(const LitPatches& lit, const CurvePoint& a, const CurvePoint& b,
                       double share) {
    return onPiece(lit, a.other, a.s + share * (b.s - a.s));
}

}  // namespace bandvox

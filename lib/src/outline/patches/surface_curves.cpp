#include "outline/patches/surface_curves.h"

#include "outline/drawing/draw_curves.h"
#include "outline/drawing/join_curves.h"
#include "outline/patches/border_curves.h"
#include "outline/patches/edge_curves.h"
#include "outline/patches/face_cuts.h"
#include "outline/patches/fold_curves.h"
#include "outline/patches/meeting_curves.h"
#include "outline/patches/refine_point.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace bandvox {
namespace {

double cosineOf(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180);
}

/// Makes the curves of one drawing.
class SurfaceCurves {
  public:
    SurfaceCurves(const LitPatches& lit, const OutlineOptions& options,
                  const CurveSampling& sampling, Progress& progress)
        : mLit(lit), mOptions(options), mSampling(sampling), mProgress(progress) {}

    std::vector<Curve> make() {
        std::vector<Curve> folds = ofEachPatch([&](int k) {
            return cut(foldCurves(mLit.seen[static_cast<std::size_t>(k)], k, mSampling));
        });
        const std::vector<SharedSide> sides = matchSides(mLit.patches, mLit.seen, mLit.faces);
        BorderCurves borders = bordersOf(sides, folds, mOptions.creaseAngle);
        std::vector<Curve> seams;
        if (mOptions.fill == OutlineFillKind::Toon) seams = seamsOf(sides, folds);
        append(folds, borders.contours);
        std::vector<Curve> meetings;
        if (mOptions.intersections || mOptions.fill != OutlineFillKind::None) {
            meetings = cut(meetingCurves(mLit.seen, sides, mLit.faces, mSampling, mProgress));
        }
        for (auto* kind : {&folds, &borders.boundaries, &borders.creases, &meetings, &seams}) {
            join(std::move(*kind));
        }
        for (const double cosine : allIsophotes(mOptions)) {
            const PointBetween between = [&](const CurvePoint& a, const CurvePoint& b, double s) {
                return isophoteBetween(mLit, a, b, s);
            };
            join(ofEachPatch([&](int k) {
                return cutToFaces(isophoteCurves(mLit, k, cosine, mSampling), mLit.faces, between);
            }));
        }
        return std::move(mCurves);
    }

  private:
    // Tones jump where normals do, be it by little.
    std::vector<Curve> seamsOf(const std::vector<SharedSide>& sides,
                               const std::vector<Curve>& folds) const {
        constexpr double kLeastDegrees = 0.01;
        if (mOptions.creaseAngle <= kLeastDegrees) return {};
        std::vector<Curve> seams = bordersOf(sides, folds, kLeastDegrees).creases;
        for (Curve& curve : seams) curve.isDrawn = false;
        return seams;
    }

    // The sides of patches, as far as they belong to faces, and the edges of these.
    BorderCurves bordersOf(const std::vector<SharedSide>& sides, const std::vector<Curve>& folds,
                           double creaseAngle) const {
        const double crease = cosineOf(creaseAngle);
        BorderCurves borders =
            borderCurves(mLit.patches, mLit.seen, sides, folds, crease, mSampling);
        if (!mLit.faces) return borders;
        BorderCurves edges = edgeCurves(mLit, folds, crease, mSampling);
        for (auto kind :
             {&BorderCurves::boundaries, &BorderCurves::creases, &BorderCurves::contours}) {
            borders.*kind = cut(std::move(borders.*kind));
            append(borders.*kind, edges.*kind);
        }
        return borders;
    }

    std::vector<Curve> cut(std::vector<Curve> curves) const {
        return cutToFaces(std::move(curves), mLit.faces,
                          [&](const CurvePoint& a, const CurvePoint& b, double share) {
                              return pointBetween(mLit.seen, a, b, share);
                          });
    }

    template <class CurvesOf>
    std::vector<Curve> ofEachPatch(const CurvesOf& curvesOf) const {
        std::vector<std::vector<Curve>> perPatch(mLit.seen.size());
        parallelFor(static_cast<std::int64_t>(perPatch.size()), [&](std::int64_t i) {
            mProgress.throwIfInterrupted();
            perPatch[static_cast<std::size_t>(i)] = curvesOf(static_cast<int>(i));
        });
        std::vector<Curve> curves;
        for (auto& some : perPatch) append(curves, some);
        return curves;
    }

    static void append(std::vector<Curve>& curves, std::vector<Curve>& more) {
        std::move(more.begin(), more.end(), std::back_inserter(curves));
    }

    void join(std::vector<Curve> curves) {
        std::vector<Curve> joined = joinCurves(std::move(curves), mSampling);
        append(mCurves, joined);
    }

    const LitPatches& mLit;
    const OutlineOptions& mOptions;
    const CurveSampling& mSampling;
    Progress& mProgress;
    std::vector<Curve> mCurves;
};

}  // namespace

std::vector<Curve> surfaceCurves(const LitPatches& lit, const OutlineOptions& options,
                                 const CurveSampling& sampling, Progress& progress) {
    return SurfaceCurves(lit, options, sampling, progress).make();
}

}  // namespace bandvox

#include "outline/patches/patch_scene.h"

#include "outline/patches/edge_curves.h"
#include "outline/patches/refine_point.h"

#include <algorithm>

namespace bandvox {
namespace {

// A surface in front has to be nearer by this part of the page's size, since the curve's own
// surface is met there, too, twice where it folds.
constexpr double kDepthMargin = 1e-7;

// Faces of an edge may be in front of it by their gap, the more the steeper they are seen.
constexpr double kSteepest = 30;

class PatchReader final : public CurveReader {
  public:
    PatchReader(const LitPatches& lit, const Sheets& sheets, double size)
        : mLit(lit), mSheets(sheets), mSize(size) {}

    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) override {
        const bool isIsophote = a.rule == CurveRule::Isophote && b.rule == CurveRule::Isophote;
        if (isIsophote && a.patch == b.patch && a.t == b.t) {
            return isophoteBetween(mLit, a, b, share);
        }
        const bool isEdge = a.rule == CurveRule::Edge && b.rule == CurveRule::Edge;
        if (isEdge && a.other == b.other) return edgeBetween(mLit, a, b, share);
        return pointBetween(mLit.seen, a, b, share);
    }

    int countBefore(const CurvePoint& point) override {
        const double margin = kDepthMargin * mSize;
        if (point.rule != CurveRule::Edge) return mSheets.countBefore(point, margin);
        const EdgeFaces own = facesAt(mLit, point);
        return mSheets.countBefore(point, margin, own.faces, std::max(margin, kSteepest * own.gap));
    }

    double foldAt(const CurvePoint& point, bool isOther) override {
        const bool isSecond = isOther && point.other >= 0;
        const auto index = static_cast<std::size_t>(isSecond ? point.other : point.patch);
        return evaluate(mLit.seen[index].f, isSecond ? point.s : point.u,
                        isSecond ? point.t : point.v)
            .value;
    }

    SeenSurface seenAt(double x, double y) override {
        const auto place = mSheets.firstAt(x, y);
        if (!place) return {};
        return {mLit.seen[static_cast<std::size_t>(place->patch)].object, place->z,
                lightCosine(mLit, place->patch, place->u, place->v)};
    }

    double cosineAt(const CurvePoint& point) override {
        return lightCosine(mLit, point.patch, point.u, point.v);
    }

  private:
    const LitPatches& mLit;
    const Sheets& mSheets;
    double mSize;
};

}  // namespace

PatchScene::PatchScene(const LitPatches& lit, double size)
    : mLit(lit), mSheets(lit.seen, lit.faces), mSize(size) {}

std::unique_ptr<CurveReader> PatchScene::reader() const {
    return std::make_unique<PatchReader>(mLit, mSheets, mSize);
}

}  // namespace bandvox

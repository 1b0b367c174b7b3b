#include "outline/patches/patch_scene.h"

#include "outline/patches/refine_point.h"

namespace bandvox {
namespace {

// A surface in front has to be nearer by this part of the page's size, since the curve's own
// surface is met there, too, twice where it folds.
constexpr double kDepthMargin = 1e-7;

class PatchReader final : public CurveReader {
  public:
    PatchReader(std::span<const ViewPatch> patches, const Sheets& sheets, double size)
        : mPatches(patches), mSheets(sheets), mSize(size) {}

    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) override {
        return pointBetween(mPatches, a, b, share);
    }

    int countBefore(const CurvePoint& point) override {
        return mSheets.countBefore(point, kDepthMargin * mSize);
    }

    double foldAt(const CurvePoint& point, bool isOther) override {
        const auto index = static_cast<std::size_t>(isOther ? point.other : point.patch);
        return evaluate(mPatches[index].f, isOther ? point.s : point.u, isOther ? point.t : point.v)
            .value;
    }

  private:
    std::span<const ViewPatch> mPatches;
    const Sheets& mSheets;
    double mSize;
};

}  // namespace

PatchScene::PatchScene(std::span<const ViewPatch> patches, double size)
    : mPatches(patches), mSheets(patches), mSize(size) {}

std::unique_ptr<CurveReader> PatchScene::reader() const {
    return std::make_unique<PatchReader>(mPatches, mSheets, mSize);
}

}  // namespace bandvox

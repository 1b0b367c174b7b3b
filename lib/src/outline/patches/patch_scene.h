#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/patches/sheets.h"

#include <span>

namespace bandvox {

/// Patches as the surfaces of a drawing.
class PatchScene final : public CurveScene {
  public:
    /// `size`: of the page. The patches are kept by reference.
    PatchScene(std::span<const ViewPatch> patches, double size);

    std::unique_ptr<CurveReader> reader() const override;

  private:
    std::span<const ViewPatch> mPatches;
    Sheets mSheets;
    double mSize;
};

}  // namespace bandvox

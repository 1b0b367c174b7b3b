#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/patches/isophotes.h"
#include "outline/patches/sheets.h"

#include <memory>

namespace bandvox {

/// Patches as the surfaces of a drawing.
class PatchScene final : public CurveScene {
  public:
    /// `size`: of the page. The patches are kept by reference.
    PatchScene(const LitPatches& lit, double size);

    std::unique_ptr<CurveReader> reader() const override;

  private:
    LitPatches mLit;
    Sheets mSheets;
    double mSize;
};

}  // namespace bandvox

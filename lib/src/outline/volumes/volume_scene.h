#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/patches/isophotes.h"
#include "outline/volumes/volume_equations.h"

#include <memory>
#include <span>

namespace bandvox {

/// The surfaces of volumes as those of a drawing, with patches beside them.
class VolumeScene final : public CurveScene {
  public:
    /// The volumes, and the patches if they are not null, are kept by reference, and
    /// so is what lights them. `firstObject`: the number of the first volume's object.
    VolumeScene(std::span<const VolumeSurface> volumes, const CurveScene* patches,
                const LitPatches& lit, int firstObject)
        : mVolumes(volumes), mPatches(patches), mLit(lit), mFirstObject(firstObject) {}

    std::unique_ptr<CurveReader> reader() const override;

  private:
    std::span<const VolumeSurface> mVolumes;
    const CurveScene* mPatches;
    const LitPatches& mLit;
    int mFirstObject;
};

}  // namespace bandvox

#pragma once

#include "outline/curve_scene.h"
#include "outline/volume_surface.h"

#include <memory>
#include <span>

namespace bandvox {

/// The surfaces of volumes as those of a drawing, with patches beside them.
class VolumeScene final : public CurveScene {
  public:
    /// What is given is kept by reference. `patches` may be null.
    VolumeScene(std::span<const VolumeSurface> volumes, const CurveScene* patches)
        : mVolumes(volumes), mPatches(patches) {}

    std::unique_ptr<CurveReader> reader() const override;

  private:
    std::span<const VolumeSurface> mVolumes;
    const CurveScene* mPatches;
};

}  // namespace bandvox

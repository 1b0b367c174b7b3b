#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/volumes/volume_equations.h"

#include <openvdb/Types.h>

#include <memory>
#include <span>

namespace bandvox {

/// The surfaces of volumes as those of a drawing, with patches beside them.
class VolumeScene final : public CurveScene {
  public:
    /// The volumes, and the patches if they are not null, are kept by reference. `light`: of
    /// isophotes, world, length 1. `firstObject`: the number of the first volume's object.
    VolumeScene(std::span<const VolumeSurface> volumes, const CurveScene* patches,
                const openvdb::Vec3d& light, int firstObject)
        : mVolumes(volumes), mPatches(patches), mLight(light), mFirstObject(firstObject) {}

    std::unique_ptr<CurveReader> reader() const override;

  private:
    std::span<const VolumeSurface> mVolumes;
    const CurveScene* mPatches;
    openvdb::Vec3d mLight;
    int mFirstObject;
};

}  // namespace bandvox

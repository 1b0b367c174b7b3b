#pragma once

#include "outline/patches/patch_scene.h"
#include "outline/volumes/volume_scene.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/volumes_to_outline.h>

#include <memory>
#include <vector>

namespace bandvox {

/// Volumes and patches on a page, and all curves of a drawing of them, seen or hidden.
class VolumeDrawing {
  public:
    /// The patches are kept by reference. Throws as volumesToOutline.
    VolumeDrawing(const std::vector<OutlineVolume>& volumes, const PatchModel& patches,
                  const OutlineOptions& options, Progress& progress);
    VolumeDrawing(const VolumeDrawing&) = delete;
    VolumeDrawing& operator=(const VolumeDrawing&) = delete;

    const std::vector<Curve>& curves() const { return mCurves; }
    const CurveScene& scene() const { return *mScene; }
    const std::vector<VolumeSurface>& surfaces() const { return mSurfaces; }

  private:
    std::vector<std::unique_ptr<SurfaceObject>> mObjects;
    std::vector<ViewPatch> mPatches;
    FaceRegions mFaces;
    LitPatches mLit;
    std::vector<VolumeSurface> mSurfaces;
    std::vector<Curve> mCurves;
    std::unique_ptr<PatchScene> mPatchScene;  // null without patches
    std::unique_ptr<VolumeScene> mScene;
};

}  // namespace bandvox

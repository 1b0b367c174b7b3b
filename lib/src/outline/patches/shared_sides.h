#pragma once

#include "outline/patches/view_patch.h"
#include "source/face_regions.h"

#include <bandvox/source/bezier_patch.h>

#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// A side of a patch: 0 to 3 for u = 0, u = 1, v = 0, v = 1.
struct PatchSide {
    int patch = 0, side = 0;
};

/// A side with the one of another patch, or the same, that has its control points.
struct SharedSide {
    PatchSide a;
    std::optional<PatchSide> b;  ///< none: the surface ends there
    bool reversed = false;       ///< b's parameter is 1 - t where a's is t
    bool isCrowded = false;      ///< more than two patches meet there
};

/// The sides of all patches that are no points, each once; of faces only those within, since
/// edges have the others.
std::vector<SharedSide> matchSides(std::span<const BezierPatch> patches,
                                   std::span<const ViewPatch> seen,
                                   const FaceRegions* faces = nullptr);

}  // namespace bandvox

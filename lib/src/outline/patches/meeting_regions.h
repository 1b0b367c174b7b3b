#pragma once

#include "outline/patches/patch_cell.h"

#include <memory>
#include <vector>

namespace bandvox {

/// Squares of the parameters of two patches that may meet there.
struct MeetingRegion {
    double u0 = 0, v0 = 0, sizeA = 1;  ///< of the first patch
    double s0 = 0, t0 = 0, sizeB = 1;  ///< of the second one
    std::shared_ptr<const PatchCell> cellA, cellB;
};

/// Where two patches may meet, but for the sides and corners that they share, or where one meets
/// itself if both are the same. In a region both patches are nearly flat and their normals nowhere
/// parallel, unless it is smaller than `least`, in the space of the view.
std::vector<MeetingRegion> meetingRegions(const PatchCell& a, const PatchCell& b, double least,
                                          double reach);

/// Whether both patches have a corner in the same place.
bool shareCorner(const PatchCell& a, const PatchCell& b, double reach);

}  // namespace bandvox

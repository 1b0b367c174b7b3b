#pragma once

#include "outline/patches/meeting_march.h"
#include "outline/patches/shared_sides.h"
#include "outline/patches/view_patch.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// The branches in which two patches meet; both may be the same.
struct MeetingPair {
    int first = 0, second = 0;  ///< first <= second
    std::vector<MeetingBranch> branches;
};

/// All branches of all pairs of patches, but for those of one shell. `size`: of the page.
std::vector<MeetingPair> meetingBranches(std::span<const ViewPatch> seen,
                                         std::span<const SharedSide> sides, double size,
                                         Progress& progress, const FaceRegions* faces = nullptr);

}  // namespace bandvox

#pragma once

#include "outline/view_patch.h"

#include <bandvox/outline/patches_to_outline.h>

#include <vector>

namespace bandvox {

/// The view of patches on a page, whose depths span as much as its longer side. It is turned by a
/// trifle, so that nothing is seen exactly edge-on or from its axis: contours move by no more than
/// the square of that. Throws Error(ErrorKind::Usage) if a patch reaches behind the eye.
ViewMatrix pageView(const std::vector<BezierPatch>& patches, const OutlineOptions& options);

}  // namespace bandvox

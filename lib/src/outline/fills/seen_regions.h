#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/drawing/visible_pieces.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/outline/outline_options.h>

#include <span>
#include <vector>

namespace bandvox {

/// The regions of the page in which one object is seen, in one tone, ordered by object and tone.
/// Lines that are seen divide the page; a few lines of sight tell what each part shows; parts that
/// show the same are one. So no order from far to near is needed, and objects that overlap in a
/// cycle are no special case. Borders are fitted as lines are, and neighbours share theirs.
std::vector<OutlineFill> seenRegions(std::span<const VisiblePiece> pieces, const CurveScene& scene,
                                     const OutlineOptions& options, Progress& progress);

}  // namespace bandvox

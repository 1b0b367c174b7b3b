#pragma once

#include "outline/patches/view_patch.h"

#include <vector>

namespace bandvox {

/// A stretch of the curve F = 0 within a rectangle of parameters where one of them, the lead, goes
/// along it and the other one, as F rises or falls strictly with it, follows from F = 0.
struct FoldStretch {
    bool leadIsU = false;
    double lead0 = 0, lead1 = 0;      ///< lead0 < lead1
    double follow0 = 0, follow1 = 0;  ///< between which the follower is
    double start = 0, end = 0;        ///< the follower at lead0 and lead1

    /// Parameters (u, v) of the curve where the lead has a value; `guess`: about what the follower
    /// is there.
    std::array<double, 2> at(const ViewPatch& patch, double lead, double guess) const;
};

/// All stretches of F = 0 on a patch. Nothing is missed: rectangles are divided until the Bernstein
/// coefficients of F have one sign, or those of a derivative have; then the curve's ends on the
/// rectangle's sides tell all that is in it. `looseEnds`: how far ends of stretches that belong
/// together may be apart, because of a place where F = 0 crosses itself.
struct FoldCells {
    std::vector<FoldStretch> stretches;
    double looseEnds = 1e-9;
};
FoldCells isolateFold(const ViewPatch& patch);

}  // namespace bandvox

#pragma once

#include "outline/patches/patch_cell.h"

#include <vector>

namespace bandvox {

/// Where the side of a cell may pass through another cell: the middles of a part of the side, by
/// the parameter along it, and of a part of the other cell.
struct SidePassage {
    double along = 0;             ///< of the cell that has the side
    double s = 0, t = 0;          ///< of the other one
    double sizeA = 1, sizeB = 1;  ///< of the parts
};

/// All such places: in each part the side passes through at most once, unless both are smaller than
/// `least`. `side`: 0 to 3 for u = 0, u = 1, v = 0, v = 1 of the cell. Cells with cones.
std::vector<SidePassage> sidePassages(const PatchCell& cell, int side, const PatchCell& other,
                                      double least);

}  // namespace bandvox

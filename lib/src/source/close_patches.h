#pragma once

#include "source/join_patches.h"

#include <bandvox/source/close_mesh.h>

#include <vector>

namespace bandvox {

/// Closes the loops of open sides by cones to their mean points. The new patches are added after
/// all others, with their components. Returns the holes in order of falling perimeter.
std::vector<CappedHole> capLoops(std::vector<BezierPatch>& patches, JoinedPatches& joined);

/// Closes a height field downwards, to the plane z = base: turns it up, adds walls and a bottom.
/// Throws Error(ErrorKind::Usage) if it is none, in more than one piece or with other than one
/// border.
void standOnBase(std::vector<BezierPatch>& patches, JoinedPatches& joined, double base);

}  // namespace bandvox

#pragma once

#include "source/cad_shape.h"

#include <bandvox/source/bezier_patch.h>

namespace bandvox {

/// The Bézier patches of faces, and how they make up the faces. Normals are turned outward; loops
/// that go around all of a surface are left away.
PatchModel patchesOf(CadShape shape);

}  // namespace bandvox

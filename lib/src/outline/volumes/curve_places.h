#pragma once

#include "outline/volumes/volume_equations.h"

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>

#include <functional>
#include <memory>
#include <vector>

namespace bandvox {

/// Makes the equations of curves on a surface, for one thread.
using EquationsMaker = std::function<std::unique_ptr<CurveEquations>()>;

/// Places on all curves that equations have on a volume's surface, many on each: one for every cell
/// of the lattice at whose edges, where they pass through the surface, g has both signs. So none is
/// missed that is larger than a cell. They do not depend on the number of threads.
std::vector<openvdb::Vec3d> curvePlaces(const VolumeSurface& surface,
                                        const EquationsMaker& equations, Progress& progress);

}  // namespace bandvox

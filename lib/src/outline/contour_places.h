#pragma once

#include "outline/volume_surface.h"

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>

#include <vector>

namespace bandvox {

/// Places on all contours of a volume's surface, many on each: one for every cell of the lattice in
/// which the surface, at the edges of the cell, faces the eye here and turns away there. So no
/// contour is missed that is larger than a cell. They do not depend on the number of threads.
std::vector<openvdb::Vec3d> contourPlaces(const VolumeSurface& surface, Progress& progress);

}  // namespace bandvox

#pragma once

#include "true_surface.h"

#include <string>
#include <vector>

namespace paper_figures {

/// A solid of the figures, and its true surface.
struct Solid {
    std::string name;
    FieldPtr field;
    SurfacePtr surface;
};

/// The hyperboloid, the sphere of radius 1 and the cube of side 1.5 of figures 1 to 5, 8 and 9,
/// turned so that the cube shows three faces, and moved out of the domain's middle.
std::vector<Solid> solids(const openvdb::Vec3d& move = openvdb::Vec3d(0.0));

/// Two balls of radius 0.48 with a gap between them, world units, in figure 10 (a).
FieldPtr twoBalls(double gap);

/// The tree of figure 10 (b).
FieldPtr tree();

}  // namespace paper_figures

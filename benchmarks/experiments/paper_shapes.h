#pragma once

#include <bandvox/source/mesh_source.h>

namespace bandvox::experiments {

/// Shapes of the kind that N. Nakamura et al. measure on: "Fast Generation Method from Boundary
/// Representation Model to Binary Voxel Data by Using GPU", figure 4. Both are unions of closed
/// parts, and turned by angles that are nothing special, so that no face lies along the lattice.

/// Boxes and bars: a seat, four splayed legs and the rungs between them, a back of posts and slats.
/// About 2 high.
MeshSource chair();

/// Three twisted blades of an aerofoil's section, and a hub. About 2 wide.
MeshSource propeller();

}  // namespace bandvox::experiments

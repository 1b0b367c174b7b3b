#pragma once

#include <bandvox/render/scene.h>

#include <openvdb/Types.h>

namespace bandvox {

/// Where an object of a scene is put: what is done to it, in this order.
struct Placement {
    double scale = 1;                   ///< about the world's origin, above 0
    openvdb::Vec3d rotate{0, 0, 0};     ///< degrees about x, then y, then z
    openvdb::Vec3d translate{0, 0, 0};  ///< world units

    bool isIdentity() const {
        return scale == 1 && rotate == openvdb::Vec3d(0.0) && translate == openvdb::Vec3d(0.0);
    }
};

/// Puts the grids of an object elsewhere; copies share their voxels. Throws Error(ErrorKind::Usage)
/// for a scale that makes voxels smaller than OpenVDB takes, or that is not above 0.
void place(SceneObject& object, const Placement& placement);

}  // namespace bandvox

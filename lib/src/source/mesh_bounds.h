#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/math/BBox.h>

namespace bandvox {

/// The box of a mesh's points, those that no triangle uses included; world units.
inline openvdb::BBoxd boundsOf(const Mesh& mesh) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& p : mesh.points) box.expand(p);
    return box;
}

}  // namespace bandvox

#include "grid/array_lattice.h"

#include "core/smallest_voxel.h"
#include "core/words.h"

#include <bandvox/core/error.h>

#include <cmath>

namespace bandvox {

openvdb::math::Transform::Ptr latticeOf(const ArrayInfo& info) {
    const double side = std::cbrt(std::abs(info.toWorld.getMat3().det()));
    if (!(side >= kSmallestVoxel)) {
        throw Error(ErrorKind::Input, info.name + ": a voxel is " + inShort(side) +
                                          " world units, and OpenVDB's transforms take no less "
                                          "than " +
                                          inShort(kSmallestVoxel) +
                                          "; give its size in a smaller unit, as in millimetres");
    }
    return openvdb::math::Transform::createLinearTransform(info.toWorld);
}

}  // namespace bandvox

#include "source/patch.h"

namespace bandvox {

openvdb::BBoxd QuadPatch::bounds(const ParameterCell& cell) const {
    // A bilinear map takes its extremes in corners.
    const openvdb::Vec3d corner = at(cell.u0, cell.v0).position;
    openvdb::BBoxd box(corner, corner);
    box.expand(at(cell.u1, cell.v0).position);
    box.expand(at(cell.u0, cell.v1).position);
    box.expand(at(cell.u1, cell.v1).position);
    return box;
}

}  // namespace bandvox

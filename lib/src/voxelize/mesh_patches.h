#pragma once

#include "voxelize/lattice_points.h"

#include <bandvox/source/mesh.h>

#include <openvdb/math/BBox.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// A triangle, and a rectangle of rows some of which it may meet: what the GPU draws. Sixteen
/// bytes at a time are what its shaders read.
struct MeshPatch {
    std::int32_t points[3][3];  ///< of the triangle, fixed point
    std::uint32_t y, z;         ///< rows from the tile's corner: the first, and the end << 16
    std::int32_t change;        ///< of the winding number behind it along x, 1 or -1
};
static_assert(sizeof(MeshPatch) == 48);

/// The patches of a mesh in a tile of rows: together they hold each row that a triangle meets,
/// once. Rectangles rather than triangles, because hardware puts what it draws on a grid of 1/256
/// pixels, which would lose rows, and in rectangles of whole pixels that makes no difference; the
/// shader tells which rows are met. `tile`: samples from the lattice's corner(); triangles that no
/// row crosses there are left out. They come in the mesh's order. Throws Error(ErrorKind::Memory).
std::vector<MeshPatch> patchesOf(const Mesh& mesh, const std::vector<LatticePoint>& points,
                                 ScanAxis axis, const openvdb::CoordBBox& tile);

}  // namespace bandvox

#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// A cell of the lattice has 8 corners, corner i at ((i & 1), (i >> 1 & 1), (i >> 2)); 12 edges,
// edge 4·axis + j the j-th along the axis; and 6 faces, face 2·axis + side.
namespace bandvox {

/// The lower corner of each edge of a cell; the upper one is the next along the edge's axis.
int lowerCorner(int edge);

/// The faces, one bit each, on which corners that lie across from each other are inside and the
/// other two are not. `inside`: one bit for each corner.
unsigned facesToDecide(unsigned inside);

/// The polygons in which a surface meets a cell, each a ring of edges, counter-clockwise from
/// outside.
struct CellPolygons {
    std::array<std::uint8_t, 12> edges;  ///< ring after ring
    std::array<std::uint8_t, 4> sizes;   ///< of the rings
    int rings = 0;
};

/// What the corners of a cell tell of the surface in it. `joined`: the ambiguous faces on which the
/// two corners inside are connected.
CellPolygons traceCell(unsigned inside, unsigned joined);

/// Cuts a ring into triangles along diagonals that are as short as can be, such that no two cells
/// have the same diagonal. `places` has one for each edge of the ring; triangles are triples of
/// numbers of the ring, appended. Returns false, and appends nothing, for the few rings of nine
/// edges for which there is none.
bool cutRing(std::span<const std::uint8_t> ring, std::span<const openvdb::Vec3d> places,
             std::vector<openvdb::Vec3I>& triangles);

}  // namespace bandvox

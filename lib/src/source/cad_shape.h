#pragma once

#include <bandvox/source/bspline_patch.h>
#include <bandvox/source/face_topology.h>

#include <string>
#include <vector>

namespace bandvox {

/// A part of an edge in a face's parameters, [0, 1]².
struct CadPiece {
    ParameterCurve curve;
    double from = 0, to = 1;  ///< the edge's parameter, 0 to 1 for all of it
};

/// An edge as one of a face's wires goes along it.
struct CadEdgeUse {
    int edge = -1;            ///< none: the surface has a point there
    bool isReversed = false;  ///< the wire goes against the edge
    std::vector<CadPiece> pieces;
};

/// A face: a B-spline surface, and the wires around what belongs to it.
struct CadFace {
    BsplineNet net;
    bool isReversed = false;  ///< the normal ∂S/∂u × ∂S/∂v points inward
    int shell = 0, object = 0;
    std::vector<std::vector<CadEdgeUse>> wires;  ///< none: all of the surface
};

/// What a file of a program for constructions holds.
struct CadShape {
    std::vector<CadFace> faces;
    int edges = 0;                     ///< how many there are
    std::vector<std::string> objects;  ///< a name for each, which may be empty
    std::vector<std::string> warnings;
};

}  // namespace bandvox

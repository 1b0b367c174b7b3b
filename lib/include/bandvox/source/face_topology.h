#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace bandvox {

/// A Bézier curve in parameters: control points (u, v), one more than its degree.
using ParameterCurve = std::vector<std::array<double, 2>>;

/// Where a patch lies in a face of a boundary representation.
struct FacePlace {
    int face = -1;  ///< none: the patch is a surface of its own
    /// The part of the face's parameters, [0, 1]², that the patch is, along u and v.
    std::array<std::array<double, 2>, 2> range{{{0, 1}, {0, 1}}};
    /// Whether the next patch of the same face is at u = 0, u = 1, v = 0, v = 1.
    std::array<bool, 4> inner{};
};

/// A face: what its loops surround of a surface.
struct TrimmedFace {
    /// Faces of one shell meet in their edges and nowhere else. Normals ∂S/∂u × ∂S/∂v of closed
    /// ones point outward.
    int shell = 0;
    /// Closed loops of curves, in the face's parameters: what an odd number of loops surrounds
    /// belongs to the face. Empty: all of the surface does.
    std::vector<ParameterCurve> loops;
};

/// A part of an edge on a patch.
struct EdgePiece {
    int patch = 0;
    ParameterCurve curve;     ///< in the patch's parameters
    double from = 0, to = 1;  ///< the edge's parameter where the curve begins and ends, ascending
};

/// The side of an edge that a face has.
struct EdgeUse {
    int face = 0;
    bool isReversed = false;        ///< the face lies on the other side of it: right, not left
    std::vector<EdgePiece> pieces;  ///< from 0 to 1 of the edge's parameter
};

/// A border of faces. The curves of its uses are the same curve in space, parameter by parameter,
/// to within the accuracy of the file.
struct FaceEdge {
    std::vector<EdgeUse> uses;  ///< one where a shell is open, two within it
};

/// How patches make up the faces of a boundary representation, as programs for constructions keep
/// them.
struct FaceTopology {
    std::vector<FacePlace> places;  ///< one for each patch; empty: none belongs to a face
    std::vector<TrimmedFace> faces;
    std::vector<FaceEdge> edges;

    /// The place of a patch.
    FacePlace placeOf(std::size_t patch) const {
        return places.empty() ? FacePlace() : places[patch];
    }

    /// Adds the faces of another model, whose patches come after `patches` of this one's; they
    /// are `otherPatches`.
    void append(FaceTopology other, std::size_t patches, std::size_t otherPatches);
};

}  // namespace bandvox

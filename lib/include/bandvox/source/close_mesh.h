#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <cstddef>
#include <string>
#include <vector>

namespace bandvox {

/// Which of a mesh's pieces have their holes capped. The others are soup: triangles of which only
/// the winding number tells what they enclose.
enum class Capping {
    All,       ///< every piece
    Sensible,  ///< those whose caps do not contradict the winding number of all the triangles
    None       ///< no piece, not even where nothing has to be capped
};

/// How a mesh is made the boundary of a solid.
struct CloseMeshOptions {
    /// Points nearer than this are one, relative to the largest coordinate; 0 welds equal points
    /// only. The default is two units in the last place of a float.
    double weldTolerance = 2.4e-7;

    /// Cracks that are no wider than this are stitched, relative to the longest side of the mesh's
    /// box, nor wider than a tenth of the usual edge on its border; 0 stitches only where points
    /// lie on edges to within rounding.
    double crackTolerance = 1e-4;

    bool requireSolid = true;  ///< throw what keeps it from being a solid, besides reporting it

    Capping capping = Capping::All;  ///< other pieces go into ClosedMesh::soup
};

/// One boundary loop that was capped.
struct CappedHole {
    std::size_t edges = 0;  ///< of the loop
    double perimeter = 0;   ///< world units
    openvdb::Vec3d center;  ///< mean of its points, world units
};

/// What was found, and what was done about it.
struct CloseMeshReport {
    std::size_t pointsWelded = 0;         ///< points that fell together with another
    std::size_t degenerateTriangles = 0;  ///< no area; dropped if two corners are equal
    std::size_t duplicateTriangles = 0;   ///< same corners as another; dropped
    std::size_t crackPoints = 0;          ///< points joined across cracks
    std::size_t edgesSplit = 0;           ///< at points of others that lie on them (T-junctions)
    std::size_t components = 0;           ///< connected pieces
    std::size_t trianglesFlipped = 0;     ///< to agree with their neighbours, or turned outward
    std::size_t componentsTurned = 0;     ///< pieces that were inside out
    std::size_t nonManifoldEdges = 0;     ///< edges of more than two triangles
    std::size_t oneSided = 0;             ///< pieces on which inside and outside cannot be told
    std::size_t soupPieces = 0;           ///< pieces that were set aside as soup
    std::size_t soupTriangles = 0;        ///< of those
    std::size_t sheets = 0;               ///< open pieces that enclose hardly anything, capped
    std::vector<CappedHole> holes;        ///< in order of falling perimeter; without those of soup
    std::vector<std::string> warnings;    ///< in words, for the user
    std::string problem;                  ///< why it bounds no solid; empty if it does
};

/// A closed mesh, and how it came about.
struct ClosedMesh {
    Mesh mesh;  ///< every directed edge has its opposite, counted with multiplicity
    Mesh soup;  ///< what only a winding number makes a solid of (SoupSource), outward; often empty
    CloseMeshReport report;
};

/// Makes a mesh the boundary of a solid: welds points, drops triangles that collapse or appear
/// twice, stitches cracks, makes the orientation of each piece consistent, caps boundary loops by
/// surfaces of little area, turns pieces outward. Triangles that have no area but three corners
/// stay, since the edges of their neighbours find their opposites there.
///
/// A piece is what is connected across edges of exactly two triangles. Of two triangles that
/// cover each other from opposite sides both are dropped, unless most of the mesh is like that:
/// then one of each two.
/// With Capping::Sensible, pieces are set aside whose caps contradict the winding number of all
/// that is not capped: panels that do not touch, shells cut up. The mesh may then be empty, but not
/// both.
///
/// A piece inside another keeps its orientation relative to the outermost piece around it, so
/// cavities stay cavities in a mesh that is inside out as a whole.
/// Throws Error(ErrorKind::Input) if nothing is left, an index is out of range or a coordinate is
/// not finite; Error(ErrorKind::Result) if what is left encloses no volume (a flat mesh, or one
/// with a single side) and a solid is required; Error(ErrorKind::Usage) for a tolerance outside [0,
/// 1).
ClosedMesh closeMesh(Mesh mesh, const CloseMeshOptions& options = {},
                     Progress& progress = silentProgress());

}  // namespace bandvox

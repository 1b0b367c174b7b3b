#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <openvdb/Types.h>

#include <cstddef>
#include <vector>

namespace bandvox {

/// A surface that can be compared with another.
struct ComparedSurface {
    Mesh mesh;                            ///< world units
    std::vector<openvdb::Vec3f> normals;  ///< one for each point, of length 1; empty: those of the
                                          ///< triangles
    double deviation = 0;  ///< of the mesh from the surface that is meant, world units, ≥ 0
};

/// How surfaces are compared.
struct CompareSurfacesOptions {
    /// The largest distance is found to within this, world units, > 0; 0: a thousandth of the
    /// diagonal of the box around both.
    double tolerance = 0;
    /// Triangles may be cut into this many pieces in all while looking for it; ≥ 0.
    std::size_t mostPieces = std::size_t(1) << 23;
};

/// How far one surface is from another: of each of its points the distance to the nearest point of
/// the other. World units.
struct OneSidedDistance {
    double maximum = 0;               ///< found: no point is known that is farther
    double atMost = 0;                ///< proven: no point of the mesh is farther than this
    openvdb::Vec3d at{0, 0, 0};       ///< the point that is so far
    openvdb::Vec3d nearest{0, 0, 0};  ///< and the other's nearest point
    double mean = 0;                  ///< over the area
    double rms = 0;
    double area = 0;  ///< of the mesh, world units²
};

/// Angles between the normals of two surfaces at nearest points, degrees, 0 to 180.
struct NormalAngles {
    double mean = 0;       ///< over the area
    double percent95 = 0;  ///< 95 % of the area have less
    double maximum = 0;
};

/// How far two surfaces, a and b, are from each other.
struct SurfaceDifference {
    OneSidedDistance fromA, fromB;
    double hausdorff = 0;        ///< the larger of the maxima, world units
    double hausdorffAtMost = 0;  ///< of the surfaces that are meant: the larger of what was proven,
                                 ///< and the deviations of both meshes
    double meanDistance = 0;     ///< over the area of both, world units
    NormalAngles angles;         ///< from a to b and from b to a, over the area of both
};

/// Measures the distances between two surfaces.
///
/// Means are taken over each triangle by the distances of its corners and its middle, a rule that
/// is exact for polynomials of degree 2; normals are compared at the middles. The maximum is looked
/// for by branch and bound: a piece of a triangle is cut into four until no point of it can be
/// farther than the farthest that was found plus the tolerance. Two bounds tell: no point is
/// farther than a point of the piece and the way from there, and the distance to one triangle of
/// the other mesh is convex, so the largest at the piece's corners. If the pieces run out, `atMost`
/// says how far the search came.
///
/// M. Tang, M. Lee, Y. J. Kim: "Interactive Hausdorff Distance Computation for General Polygonal
/// Models" (2009). The same for any number of threads; exchanging a and b exchanges the results.
/// Throws Error(ErrorKind::Usage) for options out of range or normals that are not one for each
/// point; Error(ErrorKind::Input) for a mesh without triangles, with an index out of range or with
/// a place that is not finite; Error(ErrorKind::Memory); Error(ErrorKind::Interrupted).
SurfaceDifference compareSurfaces(const ComparedSurface& a, const ComparedSurface& b,
                                  const CompareSurfacesOptions& options = {},
                                  Progress& progress = silentProgress());

}  // namespace bandvox

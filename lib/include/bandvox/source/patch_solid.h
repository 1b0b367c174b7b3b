#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/bezier_patch.h>
#include <bandvox/source/boundary_source.h>
#include <bandvox/source/close_mesh.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// How free-form patches are made the boundary of a solid.
struct PatchSolidOptions {
    /// Sides of patches are the same if they are nowhere farther apart than this, relative to the
    /// largest coordinate; 0 to below 1.
    double joinTolerance = 2.4e-7;

    /// Of pieces that overlap, only what lies outside of all others counts. Else they add up.
    bool unite = true;

    /// The solid between a surface, which has to be a height field over its border's inside, and
    /// the plane z = base, world units: walls instead of caps.
    std::optional<double> base;
};

/// What was found, and what was done about it.
struct PatchSolidReport {
    std::size_t pieces = 0;             ///< connected across sides of exactly two patches
    std::size_t patchesFlipped = 0;     ///< to agree with their neighbours, or turned outward
    std::size_t piecesTurned = 0;       ///< that were inside out
    std::size_t sidesSharedByMore = 0;  ///< sides that more than two patches share
    std::size_t piecesMeeting = 0;      ///< that others may run into or hold, if united
    std::vector<CappedHole> holes;      ///< in order of falling perimeter
    std::vector<std::string> warnings;  ///< in words, for the user
};

struct PatchSolid {
    std::unique_ptr<BoundarySource> source;
    PatchSolidReport report;
};

/// Makes the boundary of a solid of free-form patches, which are sampled as they are, without
/// tessellation. Patches that share a side are joined and turned to agree, each hole is capped by
/// the cone from its border to the border's mean point (a flat one so gets a flat cap), pieces are
/// turned outward. A piece inside another keeps its orientation relative to the outermost piece
/// around it, so that cavities stay.
///
/// In a union, a cell of the surface that others cut is integrated up to where they do, which
/// leaves the integrals as exact as others. The volume and the area are those of the pieces, with
/// a union's overlap counted once to 1e-4, relative.
///
/// Throws Error(ErrorKind::Input) without patches; Error(ErrorKind::Result) if a piece is one-sided
/// or nothing is enclosed; Error(ErrorKind::Usage) if the surface is no height field above the base
/// or the tolerance is out of range.
PatchSolid makePatchSolid(const std::string& name, std::vector<BezierPatch> patches,
                          const PatchSolidOptions& options = {},
                          Progress& progress = silentProgress());

/// The same of a model. The shells of trimmed faces have to be closed; they are neither joined nor
/// capped, they add up where they overlap, and volume and area are known to 1e-6. Also throws
/// Error(ErrorKind::Result) for open shells, and Error(ErrorKind::Usage) for a base of such.
PatchSolid makePatchSolid(const std::string& name, PatchModel model,
                          const PatchSolidOptions& options = {},
                          Progress& progress = silentProgress());

}  // namespace bandvox

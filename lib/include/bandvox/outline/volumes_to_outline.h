#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/outline/outline_options.h>
#include <bandvox/source/bezier_patch.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// A volume whose surface is drawn.
struct OutlineVolume {
    openvdb::FloatGrid::ConstPtr grid;  ///< density or level set, as for a picture; never null
    std::optional<double> iso;          ///< default: as stored, else 0.5, or 0 of a level set
    std::string name;                   ///< of the object of the drawing
};

/// Draws the contours of volumes as cubic Bézier curves: where lines of sight touch the surface
/// {f~ = iso} of the continuous density that the lattice stands for. They are followed with its
/// gradient and Hessian, with no mesh in between, and lines of sight through it tell what is
/// hidden: docs/outline.md. A contour that is smaller than a voxel may be missed.
///
/// `patches`: surfaces of the same scene, drawn as patchesToOutline does; may be empty. Volumes are
/// the drawing's objects after those of the patches.
/// Throws Error(ErrorKind::Usage) for options out of range or if the eye is within what is active,
/// Error(ErrorKind::Input) for a grid that cannot be drawn, Error(ErrorKind::Result) if nothing is
/// to be drawn, Error(ErrorKind::Interrupted).
Outline volumesToOutline(const std::vector<OutlineVolume>& volumes, const PatchModel& patches,
                         const OutlineOptions& options, Progress& progress = silentProgress());

}  // namespace bandvox

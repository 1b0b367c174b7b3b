#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/render/camera.h>
#include <bandvox/source/bezier_patch.h>

namespace bandvox {

/// How surfaces are drawn as lines.
struct OutlineOptions {
    CameraOptions camera;
    double width = 200, height = 150;  ///< of the page, in any unit; > 0
    double margin = 10;                ///< of the page that stays free, if the view is fitted
    double tolerance = 0.01;           ///< distance of lines from the true ones, page units; > 0
    double creaseAngle = 5;     ///< least angle between normals of a crease, degrees, 0 to 180
    bool intersections = true;  ///< draw where surfaces pass through each other
    bool hidden = true;         ///< keep lines that are behind something
};

/// Draws contours, boundaries, creases and intersections of surfaces as cubic Bézier curves, and
/// finds out what is hidden: everything is computed on the surfaces themselves, none of it on
/// polygons. The method is that of the paper "Vector rendering of free-form surfaces", completed
/// where it leaves questions open: docs/outline.md.
///
/// Both sides of every patch are opaque. Throws Error(ErrorKind::Usage) for options out of range or
/// if the eye is among the surfaces, Error(ErrorKind::Result) if nothing is to be drawn,
/// Error(ErrorKind::Interrupted).
Outline patchesToOutline(const PatchModel& model, const OutlineOptions& options,
                         Progress& progress = silentProgress());

}  // namespace bandvox

#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/outline/outline_options.h>
#include <bandvox/source/bezier_patch.h>

namespace bandvox {

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

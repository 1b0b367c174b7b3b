#pragma once

#include "outline/drawing/curve_scene.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/outline/outline_options.h>
#include <bandvox/source/bezier_patch.h>

#include <span>

namespace bandvox {

/// Throws Error(ErrorKind::Usage) for options out of range.
void requireValid(const OutlineOptions& options);

/// Throws Error(ErrorKind::Input) for control points that are not finite, or of no weight.
void requireFinite(const PatchModel& model);

/// How densely curves have to be known for a drawing.
CurveSampling samplingFor(const OutlineOptions& options);

/// Finds out what is hidden of curves, and fits cubics to them. Objects are left to be named.
/// Throws Error(ErrorKind::Result) if nothing is left to draw.
Outline drawCurves(std::span<const Curve> curves, const CurveScene& scene,
                   const OutlineOptions& options, Progress& progress);

}  // namespace bandvox

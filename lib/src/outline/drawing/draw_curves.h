#pragma once

#include "outline/drawing/curve_scene.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline.h>
#include <bandvox/outline/outline_options.h>
#include <bandvox/source/bezier_patch.h>

#include <span>
#include <vector>

namespace bandvox {

/// Throws Error(ErrorKind::Usage) for options out of range.
void requireValid(const OutlineOptions& options);

/// Throws Error(ErrorKind::Input) for control points that are not finite, or of no weight.
void requireFinite(const PatchModel& model);

/// How densely curves have to be known for a drawing.
CurveSampling samplingFor(const OutlineOptions& options);

/// Cosines of all curves that an isophote is to be found for, drawn or to tell tones apart.
std::vector<double> allIsophotes(const OutlineOptions& options);

/// Finds out what is hidden of curves, fits cubics to them, and fills what is between. Objects are
/// left to be named.
/// Throws Error(ErrorKind::Result) if nothing is left to draw.
Outline drawCurves(std::span<const Curve> curves, const CurveScene& scene,
                   const OutlineOptions& options, Progress& progress);

}  // namespace bandvox

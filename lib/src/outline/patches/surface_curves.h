#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/isophotes.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/outline_options.h>

#include <vector>

namespace bandvox {

/// All curves that a drawing of patches may show, seen or hidden, joined across their sides; with
/// a fill also those that only tell regions apart.
std::vector<Curve> surfaceCurves(const LitPatches& lit, const OutlineOptions& options,
                                 const CurveSampling& sampling, Progress& progress);

}  // namespace bandvox

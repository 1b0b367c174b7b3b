#pragma once

#include "bandlimit/density_column.h"
#include "bandlimit/fill_columns.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

#include <vector>

namespace bandvox {

/// True if parts of the surface overlap, so that they add up, or are inside out. Told from the
/// whole numbers away from the surface, and in parts too thin to have such from densities beyond
/// [0, 1], which only a filter that rings reaches without an overlap: where it does so by more
/// than at a flat face, the surface is filtered once more, with one that never rings.
///
/// `statistics` are those of the columns of `layout`. What lifts the density by less than ringing
/// does, or by less than a hundredth, is let through. `memory`: bytes that the second look may
/// take, as ColumnFiller has it. Throws Error(ErrorKind::Interrupted).
bool findOverlap(const BoundarySource& source, const DensityOptions& options,
                 const TileLayout& layout, const std::vector<ColumnStatistics>& statistics,
                 Progress& progress, double memory = ColumnFiller::kUnlimited);

}  // namespace bandvox

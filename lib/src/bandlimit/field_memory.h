#pragma once

#include "bandlimit/tile_plan.h"

#include <bandvox/source/field_source.h>

namespace bandvox {

/// About how many 8³ blocks of the lattice hold more than one value, from where the field says
/// that it is constant within the filter's reach; all of them if it never does.
double estimateVaryingBlocks(const FieldSource& source, const TileGeometry& geometry,
                             const TileLayout& layout);

}  // namespace bandvox

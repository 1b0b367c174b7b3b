#pragma once

#include "grid/merge_values.h"

#include <bandvox/grid/merge_grids.h>

namespace bandvox {

/// Says of a merged grid what follows from what its inputs say of themselves.
void describeMerged(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                    const MergeOptions& options, const MergeRule& rule, MergeResult& result);

}  // namespace bandvox

#pragma once

#include <bandvox/scatter/spline_volume_to_grids.h>

#include <string>
#include <vector>

// What the columns of a table stand for.
namespace bandvox::app {

/// The index of the first of three columns that are colours, or -1: r, g and b, or red, green and
/// blue, or Cd.r, Cd.g and Cd.b, one after another, in any case.
int redColumn(const std::vector<std::string>& names);

/// A grid for each column, named after it; three that are a colour become `Cd`, three named after
/// the axes, as vel.x, vel.y and vel.z or vx, vy and vz, vectors, and u, v and w `vel`. A column
/// without a name becomes `density`.
std::vector<ColumnGrid> gridsOfColumns(const std::vector<std::string>& names);

}  // namespace bandvox::app

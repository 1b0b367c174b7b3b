#pragma once

#include "bandlimit/density_column.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/source/boundary_source.h>

// What the exact route does alike whether its grid fits into memory or not.
namespace bandvox {

/// How the work on a source is cut up. Throws what surfaceToDensity does for options out of range.
struct ExactRoute {
    ExactRoute(const BoundarySource& surface, const DensityOptions& asked);

    const BoundarySource& source;
    const DensityOptions& options;
    double voxelSize;  ///< world units
    TilePlan plan;
    TileLayout layout;

    /// What is made, for errors that say that it does not fit.
    std::string wanted() const;

    /// How far the density may be from whole numbers away from the surface. What the lattice cannot
    /// hold keeps ringing there; it is warned of.
    double allowedError() const;

    /// Takes a finer quadrature after attempt number `attempt`, from 0, has come out with an error
    /// beyond what is allowed. Throws Error(ErrorKind::Result) if that is not the quadrature's, or
    /// it has been refined often enough.
    void refine(int attempt, double error);
};

/// Bytes that work takes, about.
struct ExactRouteMemory {
    ExactRouteMemory(const ExactRoute& route, const TileFilter& filter);

    double leaves;    ///< a number: leaf nodes of the grid
    double columns;   ///< what is kept of each column of tiles
    double elements;  ///< the source's, sorted
    double bricks;    ///< what all columns share
    double thread;    ///< work arrays of one thread
};

/// Says in the result what filling the columns has measured, once `overlaps` is known. Then the
/// grid is to be made, limited if the metadata say so.
void stateMeasured(const ExactRoute& route, const ColumnStatistics& statistics,
                   DensityResult& result);

/// Completes the result, whose grid has been made.
void stateGrid(const ExactRoute& route, const ColumnStatistics& statistics, DensityResult& result);

}  // namespace bandvox

#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

namespace bandvox {

/// Turns the solid inside a closed surface into a band-limited density grid, by the exact route:
/// the solid is never sampled; its derivative along x, which lives on the surface, is
/// integrated, filtered in tiles, and summed up again (docs/math/exact-route.md).
///
/// The grid's index 0 lies at the world's origin. It is active wherever the density differs from 0
/// by more than 3/8 of the tolerance, and deep inside it is made of active tiles of value 1. Where
/// shells of the surface overlap or are inside out, that is a warning, and the density is limited
/// to [0, 1].
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Input) if a voxel
/// would be smaller than OpenVDB takes, Error(ErrorKind::Memory) before allocating if it would
/// not fit, Error(ErrorKind::Result) if the measured error is above the tolerance (or what the
/// filter leaves at Nyquist, if that is more) or the grid would be empty,
/// Error(ErrorKind::Interrupted).
DensityResult surfaceToDensity(const BoundarySource& source, const DensityOptions& options = {},
                               Progress& progress = silentProgress());

}  // namespace bandvox

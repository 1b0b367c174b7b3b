#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>
#include <bandvox/source/field_source.h>

namespace bandvox {

/// How a field is sampled and band-limited.
struct FieldDensityOptions {
    DensityOptions density;  ///< as for the exact route; its tolerance is that of all but sampling
    int oversample = 8;      ///< P = R/N, samples along a voxel's side; 1 to 64
    double samplingTolerance = 0.05;  ///< sampling error allowed without a warning, density; ≥ 0
};

/// Turns a field into a band-limited density grid, by the sampled route: tile by tile the field is
/// sampled P times in a voxel along each axis, and the frequencies that the lattice can hold are
/// taken from the samples by Algorithm I (docs/math/sampled-route.md). Memory is that of the grid
/// and of one tile's low frequencies for each thread, whatever the number of samples.
///
/// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), section 5.1.
///
/// Lattice and grid are as those of surfaceToDensity. The tolerance holds for fields about as large
/// as 1. What the samples cannot tell is measured, for an even P, by the difference from every
/// second sample, in every tile. Twice that is stored as the sampling error, and is a warning if
/// above `samplingTolerance`; it may be too little for parts along the lattice that are thinner
/// than three voxels. For an odd P the error is not known, which is a warning, too. The volume of
/// the source is not known. Throws Error(ErrorKind::Usage) for options out of range,
/// Error(ErrorKind::Input) if a voxel would be smaller than OpenVDB takes, Error(ErrorKind::Memory)
/// before allocating if it would not fit, Error(ErrorKind::Result) if the grid would be empty,
/// Error(ErrorKind::Interrupted).
DensityResult fieldToDensity(const FieldSource& source, const FieldDensityOptions& options = {},
                             Progress& progress = silentProgress());

}  // namespace bandvox

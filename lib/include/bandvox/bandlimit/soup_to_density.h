#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>
#include <bandvox/source/soup_source.h>

namespace bandvox {

/// How a soup is made a solid and band-limited.
struct SoupDensityOptions {
    DensityOptions density;  ///< as for the exact route; its tolerance is that of all but sampling
    int rowsPerVoxel = 4;    ///< P; P² + 1 rows through a voxel follow the solid; 1 to 64
    double samplingTolerance = 0.05;  ///< sampling error allowed without a warning, density; ≥ 0
};

/// Turns the places that a soup winds around by more than half, and those in the solid beside it,
/// into a band-limited density grid. The solid goes by the exact route; of the soup the winding
/// number is followed along rows (SoupSource), and where they enter and leave it is integrated
/// over as the exact route does with samples of a surface (docs/any-mesh.md).
///
/// Lattice and grid are as those of surfaceToDensity. What the rows cannot tell is measured by the
/// difference from every fourth of them; that is stored as the sampling error, several times as
/// large as it is on ordinary meshes (docs/any-mesh.md), and is a warning if above
/// `samplingTolerance`. Throws as surfaceToDensity, and Error(ErrorKind::Result) if the soup
/// encloses nothing.
DensityResult soupToDensity(const SoupOfTriangles& triangles,
                            const SoupDensityOptions& options = {},
                            Progress& progress = silentProgress());

}  // namespace bandvox

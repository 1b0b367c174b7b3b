#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

namespace bandvox {

/// An iso-value, and what it encloses.
struct VolumeIso {
    double iso = 0;
    double volume = 0;  ///< inside of the surface's mesh, world units³
};

/// The value whose surface encloses a volume. Filtering moves the surface of a round shape inward,
/// so what {f~ = 0.5} encloses shrinks while the integral stays; this is the value to take instead.
/// Found by the secant of the meshes' volumes (densityToMesh), to 1e-5 of `volume`, world units³.
///
/// Throws what densityToMesh does; Error(ErrorKind::Usage) unless the volume is above 0;
/// Error(ErrorKind::Input) for a level set, whose values are distances;
/// Error(ErrorKind::Result) if no value encloses that much, or so little.
VolumeIso isoOfVolume(const openvdb::FloatGrid::ConstPtr& grid, double volume,
                      Progress& progress = silentProgress());

}  // namespace bandvox

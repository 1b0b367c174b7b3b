#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <cstdint>

namespace bandvox {

/// How the values of grids are compared.
struct CompareGridsOptions {
    /// Error allowed where a lattice has to be read between its nodes, relative to the largest
    /// difference of its values from the background; 1e-6 to 0.05.
    double tolerance = 1e-5;
};

/// How the voxels that are compared lie to each other.
enum class ComparedLattices {
    Same,       ///< voxel by voxel
    Shifted,    ///< voxel by voxel, whole voxels apart
    Resampled,  ///< the second grid was read at the voxels of the first
};

/// How far the values of two grids, a and b, are from each other.
struct GridDifference {
    ComparedLattices lattices = ComparedLattices::Same;
    std::int64_t voxels = 0;        ///< that were compared; those of tiles count each
    double maximum = 0;             ///< of |b - a|
    openvdb::Vec3d at{0, 0, 0};     ///< where that is, world; the first such voxel
    double valueA = 0, valueB = 0;  ///< there
    double rms = 0;                 ///< root of the mean of (b - a)²
    double mean = 0;                ///< of b - a
    double meanAbsolute = 0;        ///< of |b - a|
    double integralA = 0;           ///< of the values of active voxels, each over its own lattice
    double integralB = 0;           ///< (densityIntegral), world units³ times those of the value
};

/// Compares the values of two grids at each voxel of the first's lattice that is active in one of
/// them, in leaves or tiles; inactive voxels count with their values. Where the lattices are whole
/// voxels apart (wholeVoxelOffset), voxels are compared as they are. Otherwise the second grid is
/// read between its nodes, by resampleGrid without a filter: frequencies that the first's lattice
/// cannot hold show as differences.
///
/// The same for any number of threads. Throws Error(ErrorKind::Usage) for a null grid or options
/// out of range; Error(ErrorKind::Input) for values that are not finite, or transforms that are not
/// linear; Error(ErrorKind::Result) if nothing is active in either; what resampleGrid throws;
/// Error(ErrorKind::Interrupted).
GridDifference compareGrids(const openvdb::FloatGrid::ConstPtr& a,
                            const openvdb::FloatGrid::ConstPtr& b,
                            const CompareGridsOptions& options = {},
                            Progress& progress = silentProgress());

}  // namespace bandvox

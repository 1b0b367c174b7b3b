#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

namespace bandvox {

/// What becomes of the densities a, b, ... at a voxel. Sum and Blend are linear: what is
/// band-limited stays so, exactly. The others differ from the filtered union, difference or
/// intersection of the solids within a filter's width of where their surfaces meet, by up to 0.1 or
/// so, Max by 0.15; elsewhere they are it. There a product has frequencies up to the sum of those
/// of a and of b, of which the default filter leaves less than its tolerance beyond Nyquist, and
/// Max has kinks, of which the lattice loses some 0.05 (docs/compare-and-merge.md).
enum class MergeOperation {
    Union,         ///< 1 - (1 - a)(1 - b)...: a + b - ab of two
    Sum,           ///< a + b + ..., each times its weight
    Max,           ///< the largest
    Blend,         ///< the mean, weighted
    Difference,    ///< a (1 - b)...: the first without the others
    Intersection,  ///< a b ...
};

/// The name of an operation, lower case.
std::string nameOf(MergeOperation operation);

/// How densities are merged.
struct MergeOptions {
    MergeOperation operation = MergeOperation::Union;
    /// Of Sum and Blend, one for each grid; default: 1 each. Those of Blend are ≥ 0, not all 0.
    std::vector<double> weights;
    bool clamp = false;  ///< limit the result to [0, 1]
    /// Of Difference and Intersection: densities as near to 0 become nothing; ≥ 0. The default is
    /// what convert leaves away at its tolerance of 1e-4.
    double threshold = 3.75e-5;
};

/// A merged density, and what it cannot say of itself.
struct MergeResult {
    openvdb::FloatGrid::Ptr grid;
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// Merges densities on one lattice, that of the first; those of the others may be whole voxels away
/// (wholeVoxelOffset). Inactive voxels count with their values; voxels of the result that are not 0
/// are active. Tiles stay tiles where each grid has one, or one decides, as 1 does of a union.
///
/// The result has the first's name, and if all have the same filter, the metadata of a density: the
/// errors of the inputs added, of Max the largest, of Blend the mean; route "merged"; the integral
/// anew; the volume of the source of Sum and Blend if all know theirs. Of other filters it says
/// nothing but its source, and is read by a spline.
///
/// The same for any number of threads. Throws Error(ErrorKind::Usage) for fewer than two grids, a
/// null one or options out of range; Error(ErrorKind::Input) for a level set, a background that is
/// not 0, values that are not finite, or lattices that differ otherwise; Error(ErrorKind::Result)
/// if nothing is left; Error(ErrorKind::Memory); Error(ErrorKind::Interrupted).
MergeResult mergeGrids(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                       const MergeOptions& options = {}, Progress& progress = silentProgress());

}  // namespace bandvox

#pragma once

#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>
#include <optional>

namespace bandvox {

/// Densities from `low` up to `high`.
struct DensityBand {
    float low, high;
};

/// How a lattice is read as a continuous density.
struct BrickReconstructionOptions {
    ExponentialFilter filter;             ///< what the lattice was filtered with
    double tolerance = 1.5e-5;            ///< error allowed: of the value in density, of the
                                          ///< gradient relative to a flat face's; 1e-6 to 0.1
    std::size_t cacheBytes = 512u << 20;  ///< memory for bricks; room for 16 is always taken
    /// If given, most places that are read lie next to nodes of such densities, as those near a
    /// surface do: then bricks are made ready there alone, as long as nobody reads elsewhere. What
    /// is read is the same.
    std::optional<DensityBand> mostlyRead;
};

/// Band-limited interpolation in bricks of 32³ voxels: when a brick is first needed, its lattice
/// values and a halo are convolved with a short filter that undoes a compact kernel; value and
/// gradient at a place are then short sums over the kernel and its derivative, which is the
/// gradient of the Fourier series, 2πik with k signed. Bricks agree where they meet
/// (docs/math/reconstruction.md). Values of inactive voxels and tiles count as they are.
///
/// Chiba, Aoki, Saito: "A Voxel Based Geometric Modeling" (1990), section 3.2.
/// Throws Error(ErrorKind::Usage) if `grid` is null, if the tolerance is out of range, or if no
/// kernel reaches it because the filter leaves too much near Nyquist.
std::unique_ptr<Reconstruction> makeBrickReconstruction(openvdb::FloatGrid::ConstPtr grid,
                                                        const BrickReconstructionOptions& options);

/// What goes through the values of a lattice that nobody has band-limited: the interpolating cubic
/// B-spline, which has two continuous derivatives, in the same bricks. Where values jump from node
/// to node it overshoots by up to a quarter of the jump. Inactive voxels and tiles count as they
/// are.
///
/// M. Unser, A. Aldroubi, M. Eden: "B-Spline Signal Processing" (1993). `mostlyRead` is as for
/// makeBrickReconstruction. Throws Error(ErrorKind::Usage) if `grid` is null.
std::unique_ptr<Reconstruction> makeSplineReconstruction(
    openvdb::FloatGrid::ConstPtr grid, std::size_t cacheBytes = 512u << 20,
    const std::optional<DensityBand>& mostlyRead = std::nullopt);

/// Averages of the values of a lattice that nobody has band-limited, weighted by the cubic
/// B-spline, in the same bricks: nothing is beyond the values of the 64 nodes around a place, so
/// that what is empty stays so, and nothing rings; an edge gets wider, by a variance of a third of
/// a voxel squared. The integral is that of the values. Inactive voxels and tiles count as they
/// are. Throws Error(ErrorKind::Usage) if `grid` is null.
std::unique_ptr<Reconstruction> makeAveragingReconstruction(openvdb::FloatGrid::ConstPtr grid,
                                                            std::size_t cacheBytes = 512u << 20);

}  // namespace bandvox

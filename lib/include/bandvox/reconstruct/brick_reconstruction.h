#pragma once

#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>

namespace bandvox {

/// How a lattice is read as a continuous density.
struct BrickReconstructionOptions {
    ExponentialFilter filter;                ///< what the lattice was filtered with
    double tolerance = 1e-4;                 ///< error of the value allowed, density
    std::size_t cacheBytes = 512u << 20;     ///< memory for bricks, at least a few
};

/// Band-limited interpolation in bricks: each brick of the lattice, with a halo, is transformed,
/// divided by the transform of a compact kernel, and transformed back, when it is first needed;
/// value and gradient at a place are then short sums over the kernel. The kernel's own
/// derivative makes the gradient that of the Fourier series, 2πik with k signed.
std::unique_ptr<Reconstruction> makeBrickReconstruction(openvdb::FloatGrid::ConstPtr grid,
                                                        const BrickReconstructionOptions& options);

}  // namespace bandvox

#pragma once

#include <bandvox/source/boundary_source.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <span>

namespace bandvox {

/// A lattice to spread to: node (x, y, z) at (x·yCount + y)·zStride + z.
struct SpreadLattice {
    float* nodes;
    int yCount;
    int zStride;
};

/// Adds to each node l of the lattice  Σ_j -n_x dA_j ψ(l - y_j), for samples at y_j (positions
/// plus `offset` on every axis, voxels) with area vector n dA. Every sample's nodes must lie
/// on the lattice; kernel.paddedWidth() nodes are touched along z.
void spreadSamples(std::span<const SurfaceSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice);

}  // namespace bandvox

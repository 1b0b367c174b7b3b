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

/// A place with two weights that are to be spread.
struct PairedSample {
    openvdb::Vec3f position;  ///< voxels, from the origin of the region it was asked for
    float weights[2];
};

/// The same for two sums at once, with these weights for -n_x dA: nodes are pairs, the first of
/// them at 2·((x·yCount + y)·zStride + z). Each of them is as if it were alone.
void spreadSamples(std::span<const PairedSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice);

}  // namespace bandvox

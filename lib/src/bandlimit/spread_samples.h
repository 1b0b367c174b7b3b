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

/// A place with a weight that is to be spread.
struct WeightedSample {
    openvdb::Vec3f position;  ///< voxels, from the origin of the region it was asked for
    float weight;
};

/// What a sample of a surface weighs for the difference along x: -n_x dA.
inline float weightOf(const SurfaceSample& sample) {
    return -sample.areaVector.x();
}
inline float weightOf(const WeightedSample& sample) {
    return sample.weight;
}

/// Adds to each node l of the lattice  Σ_j w_j ψ(l - y_j), for samples at y_j (positions plus
/// `offset` on every axis, voxels) of weight w_j (see weightOf). Every sample's nodes must lie on
/// the lattice; kernel.paddedWidth() nodes are touched along z.
void spreadSamples(std::span<const SurfaceSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice);
void spreadSamples(std::span<const WeightedSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice);

}  // namespace bandvox

#pragma once

#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <openvdb/Types.h>

#include <array>

namespace bandvox {

/// The coefficients of a brick, [nodes][nodes][pitch], whose first node is the first under the
/// kernel at the brick's first voxel.
struct BrickNodes {
    const float* coefficients;
    int nodes;  ///< along x and y
    int pitch;  ///< along z, with room for the kernel's padding
};

/// The first node under the kernel at a brick's first voxel, relative to that.
inline int firstNode(const SpreadingKernel& kernel) {
    return -(kernel.width() / 2);
}

/// The nodes around a place along one axis.
struct NodeWeights {
    int first;                                                 ///< in the brick's coefficients
    std::array<float, SpreadingKernel::kPaddedWidth> weights;  ///< as many as the kernel is wide
};

/// Those at a place relative to a brick's first voxel.
NodeWeights nodeWeights(const SpreadingKernel& kernel, double local);

// The sums f~(x) = Σ c_l ψ(l - x) and their derivatives, at a place relative to the brick's first
// voxel.

double sumValue(const BrickNodes& brick, const SpreadingKernel& kernel,
                const openvdb::Vec3d& local);
DensityAt sumGradient(const BrickNodes& brick, const SpreadingKernel& kernel,
                      const openvdb::Vec3d& local);
DensityExpansion sumHessian(const BrickNodes& brick, const SpreadingKernel& kernel,
                            const openvdb::Vec3d& local);

}  // namespace bandvox

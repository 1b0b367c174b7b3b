#pragma once

#include <openvdb/Types.h>

namespace bandvox {

/// A density and its gradient at one place.
struct DensityAt {
    double value = 0;
    openvdb::Vec3d gradient{0, 0, 0};  ///< per voxel, along the index axes
};

/// The continuous density that a lattice of samples stands for. Safe to use from many threads.
class Reconstruction {
  public:
    virtual ~Reconstruction() = default;

    /// The density at a place given in index coordinates (voxels; voxel centres are whole).
    virtual double value(const openvdb::Vec3d& index) const = 0;

    /// The density and its gradient at a place given in index coordinates.
    virtual DensityAt evaluate(const openvdb::Vec3d& index) const = 0;
};

}  // namespace bandvox

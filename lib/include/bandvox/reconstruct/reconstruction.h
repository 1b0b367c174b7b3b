#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Mat3.h>

#include <memory>

namespace bandvox {

/// A density and its gradient at one place.
struct DensityAt {
    double value = 0;
    openvdb::Vec3d gradient{0, 0, 0};  ///< per voxel, along the index axes
};

/// A density to second order at one place.
struct DensityExpansion {
    double value = 0;
    openvdb::Vec3d gradient{0, 0, 0};  ///< per voxel, along the index axes
    openvdb::Mat3d hessian;            ///< per voxel², along the index axes; symmetric
};

/// Reads a Reconstruction for one thread at a time, and remembers what it needed last: for many
/// places that are close to each other, as along a line of sight. The Reconstruction that it came
/// from must outlive it.
class DensityProbe {
  public:
    virtual ~DensityProbe() = default;

    /// The density at a place given in index coordinates (voxels; voxel centres are whole).
    virtual double value(const openvdb::Vec3d& index) = 0;

    /// The density and its gradient at a place given in index coordinates.
    virtual DensityAt evaluate(const openvdb::Vec3d& index) = 0;

    /// The density, its gradient and its Hessian at a place given in index coordinates.
    virtual DensityExpansion expand(const openvdb::Vec3d& index) = 0;
};

/// The continuous density that a lattice of samples stands for. Safe to use from many threads,
/// and the same from any of them.
class Reconstruction {
  public:
    virtual ~Reconstruction() = default;

    /// The density at a place given in index coordinates (voxels; voxel centres are whole). Takes
    /// a lock; for many places use a probe.
    virtual double value(const openvdb::Vec3d& index) const = 0;

    /// The density and its gradient at a place given in index coordinates. Takes a lock.
    virtual DensityAt evaluate(const openvdb::Vec3d& index) const = 0;

    /// The density, its gradient and its Hessian at a place given in index coordinates. Takes a
    /// lock.
    virtual DensityExpansion expand(const openvdb::Vec3d& index) const = 0;

    /// A reader for one thread, without a lock for each place.
    virtual std::unique_ptr<DensityProbe> probe() const = 0;
};

}  // namespace bandvox

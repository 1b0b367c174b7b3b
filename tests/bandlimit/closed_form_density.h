#pragma once

#include <bandvox/source/mesh.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <complex>
#include <functional>
#include <vector>

namespace bandvox {

/// The filtered density of a solid at the voxels of a cube, from the solid's own transform.
///
/// A Fourier series over a period of `side` voxels in double precision: the truth for a solid
/// near index 0 that is smaller than the period by more than the filter's reach.
class ClosedFormDensity {
  public:
    /// f̂(k) = ∫ f(x) e^{-2πik·x} dx, voxels and cycles per voxel.
    using Transform = std::function<std::complex<double>(const openvdb::Vec3d& k)>;

    ClosedFormDensity(int side, const ExponentialFilter& filter, const Transform& transform);

    /// At a voxel; each index in [-side/2, side/2).
    double operator()(const openvdb::Coord& voxel) const;

    /// The largest difference of a grid from the truth, over all voxels of the cube.
    double largestError(const openvdb::FloatGrid& grid) const;

  private:
    int mSide;
    std::vector<double> mValues;
};

/// A box with half sides `half`, turned by `rotation` about its centre `center`.
struct TurnedBox {
    openvdb::Vec3d half, center;
    openvdb::Mat3R rotation;

    ClosedFormDensity::Transform transform() const;
    Mesh mesh(double voxelSize) const;
};

ClosedFormDensity::Transform ballTransform(double radius, const openvdb::Vec3d& center);

/// An icosahedron divided `levels` times, scaled so that it encloses a ball's volume.
Mesh ballMesh(double radius, const openvdb::Vec3d& center, int levels);

/// A rotation about all three axes.
openvdb::Mat3R someRotation();

}  // namespace bandvox

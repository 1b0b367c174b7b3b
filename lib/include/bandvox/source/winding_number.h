#pragma once

#include <bandvox/source/mesh.h>

#include <memory>

namespace bandvox {

class WindingTree;

/// How often a surface winds around a point, which may have holes: the sum of the solid angles that
/// its triangles take up seen from there, over 4π. It is 1 inside of a closed surface and 0
/// outside; of one that is open it changes smoothly from 1 to 0 across the openings, so that 0.5
/// is a fair place to close them.
///
/// Triangles far away are taken together, as moments up to the second order about the middle of
/// what they are in a tree. G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson: "Fast Winding
/// Numbers for Soups and Clouds" (2018). Building the tree takes about as long as sorting the
/// triangles. An object is immutable once built, and may be asked by many threads.
class WindingNumber {
  public:
    /// Points that belong together should be one, as closeMesh leaves them. Throws
    /// Error(ErrorKind::Memory) before allocating if the tree would not fit.
    explicit WindingNumber(Mesh mesh);
    ~WindingNumber();
    WindingNumber(WindingNumber&&) noexcept;
    WindingNumber& operator=(WindingNumber&&) noexcept;

    /// At a place in the world, off by less than 1e-3 (docs/any-mesh.md measures it), in a time
    /// that grows like the logarithm of the number of triangles.
    double at(const openvdb::Vec3d& place) const;

    /// By the sum over all triangles, in double precision. On a triangle itself it is the mean of
    /// both sides.
    double exactAt(const openvdb::Vec3d& place) const;

    const WindingTree& tree() const { return *mTree; }

  private:
    std::unique_ptr<const WindingTree> mTree;
};

}  // namespace bandvox

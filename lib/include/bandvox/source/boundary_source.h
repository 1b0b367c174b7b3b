#pragma once

#include <bandvox/source/quadrature.h>

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <cstddef>
#include <string>
#include <vector>

namespace bandvox {

/// One quadrature point of a surface.
struct SurfaceSample {
    openvdb::Vec3f position;    ///< voxels, from the origin of the region it was asked for
    openvdb::Vec3f areaVector;  ///< outward normal times area, voxels²
};

/// The part of space for which a surface is sampled, and the lattice it is sampled for.
struct SamplingRegion {
    double voxelSize = 1;   ///< world units
    openvdb::Vec3d origin;  ///< corner, in voxels: world position / voxelSize
    openvdb::Vec3d extent;  ///< size along each axis, voxels
};

/// A closed oriented surface that bounds a solid, as a list of elements (triangles, patches).
///
/// All elements together are closed: every edge is shared, in opposite directions. Shells that
/// overlap add up. An object is immutable once built, and may be read by many threads.
class BoundarySource {
  public:
    virtual ~BoundarySource() = default;

    /// What it was made from: a file's name, or "shape:torus".
    virtual std::string name() const = 0;

    /// The smallest box that holds the surface, world units.
    virtual openvdb::BBoxd bounds() const = 0;

    /// The enclosed volume, world units³, as ∮ x·n dA / 3.
    virtual double volume() const = 0;

    /// The surface's area, world units².
    virtual double area() const = 0;

    virtual std::size_t elementCount() const = 0;

    /// A box that holds element i, world units.
    virtual openvdb::BBoxd elementBounds(std::size_t i) const = 0;

    /// Appends to `samples` the quadrature points of element i that lie in the region (those on
    /// its far faces excluded), dense enough for `quadrature`. A point depends on the element,
    /// the voxel size and `quadrature` alone, so regions that share it get the same one.
    virtual void sampleElement(std::size_t i, const SamplingRegion& region,
                               const SurfaceQuadrature& quadrature,
                               std::vector<SurfaceSample>& samples) const = 0;
};

}  // namespace bandvox

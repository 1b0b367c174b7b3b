#pragma once

#include "source/cell_trim.h"
#include "source/patch.h"

#include <bandvox/source/boundary_source.h>

#include <string>

namespace bandvox {

/// Appends the quadrature points of what `trim` leaves of a patch, all of it if null, as
/// BoundarySource::sampleElement does.
void samplePatch(const Patch& patch, const CellTrim* trim, const SamplingRegion& region,
                 const SurfaceQuadrature& quadrature, std::vector<SurfaceSample>& samples);

/// A closed surface made of smooth patches, sampled as it is, without tessellation.
class PatchSource final : public BoundarySource {
  public:
    /// `volume` and `area` in world units, by whoever knows the shape.
    PatchSource(std::string name, PatchList patches, double volume, double area);
    /// The same with a box that is known to be smaller than those of the patches.
    PatchSource(std::string name, PatchList patches, double volume, double area,
                const openvdb::BBoxd& bounds);

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mPatches.size(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override { return mPatches[i]->bounds({}); }
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    std::string mName;
    PatchList mPatches;
    openvdb::BBoxd mBounds;
    double mVolume;
    double mArea;
};

}  // namespace bandvox

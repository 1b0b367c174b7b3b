#pragma once

#include <bandvox/source/boundary_source.h>

#include <vector>

namespace bandvox {

/// The boundaries of several solids, which do not overlap, as one.
class JoinedSource final : public BoundarySource {
  public:
    /// Keeps references. `parts`: one at least.
    JoinedSource(std::string name, std::vector<const BoundarySource*> parts);

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mStart.back(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override;
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    std::size_t partOf(std::size_t element) const;

    std::string mName;
    std::vector<const BoundarySource*> mParts;
    std::vector<std::size_t> mStart;  // of each part's elements, and the end
    openvdb::BBoxd mBounds;
    double mVolume = 0, mArea = 0;
};

}  // namespace bandvox

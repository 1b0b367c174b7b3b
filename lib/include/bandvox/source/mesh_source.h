#pragma once

#include <bandvox/source/boundary_source.h>
#include <bandvox/source/mesh.h>

#include <string>

namespace bandvox {

/// A closed triangle mesh as the boundary of a solid; its elements are the triangles.
class MeshSource final : public BoundarySource {
  public:
    /// `mesh` is closed and outward, as closeMesh leaves it.
    MeshSource(std::string name, Mesh mesh);

    const Mesh& mesh() const { return mMesh; }

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mMesh.triangles.size(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override;
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    std::string mName;
    Mesh mMesh;
    openvdb::BBoxd mBounds;
    double mVolume = 0;
    double mArea = 0;
};

}  // namespace bandvox

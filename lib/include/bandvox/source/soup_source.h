#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>
#include <bandvox/source/mesh.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace bandvox {

class WindingRows;

/// Triangles that no repair makes the boundary of a solid, beside those that are one.
struct SoupOfTriangles {
    std::string name;  ///< a file's
    Mesh soup;         ///< with openings; its points that belong together are one
    Mesh solid;        ///< closed, as uniteShells leaves it; may be empty
};

/// For which lattice a soup of triangles is made a solid.
struct SoupOptions {
    double voxelSize = 1;         ///< world units
    int rowsPerVoxel = 4;         ///< P; P² + 1 rows pass through a voxel; 1 to 64
    const Mesh* solid = nullptr;  ///< closed; what is inside of it is taken away
};

/// The places that a surface with openings winds around by more than half, in its box, as a solid
/// with a boundary.
///
/// Rows along x, so many to a voxel, are followed through it. Where they enter and leave is as
/// exact as floats at triangles, and to a hundredth of a voxel in openings; so the only error
/// worth mentioning is that of the rows' distance from each other. The elements are bundles of
/// rows, and samples are crossings, with area vectors along x. (`quadrature` is not used.) Samples
/// without area say where a face runs along the rows.
class SoupSource final : public BoundarySource {
  public:
    /// Of a mesh whose points that belong together are one. Throws Error(ErrorKind::Result) if
    /// nothing is inside, Error(ErrorKind::Memory), Error(ErrorKind::Interrupted).
    SoupSource(std::string name, const Mesh& soup, const SoupOptions& options,
               Progress& progress = silentProgress());
    ~SoupSource() override;

    /// The same with every fourth row, which make up a lattice of twice the width, to compare with.
    std::unique_ptr<SoupSource> withFewerRows() const;

    /// How many rows there are, and how many winding numbers had to be computed for them.
    std::int64_t rowCount() const;
    std::int64_t evaluations() const;

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    /// About that: the area seen along x, twice.
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mElements.size(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override { return mElements[i].bounds; }
    /// The region has to be for the voxels that the source was made for.
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    struct Element {
        std::int64_t bundle;
        openvdb::BBoxd bounds;
    };
    SoupSource(const SoupSource& all, bool isWider);
    void findElements();
    double areaOfRow() const;
    std::span<const float> rowNear(std::int64_t bundle, int y, int z, int i) const;
    template <typename Visit>
    void forEachRow(std::int64_t bundle, const Visit& visit) const;

    std::string mName;
    std::shared_ptr<const WindingRows> mRows;
    bool mIsWider = false;  // only the rows of the lattice twice as wide are used
    std::vector<Element> mElements;
    openvdb::BBoxd mBounds;
    double mVolume = 0, mArea = 0;
};

}  // namespace bandvox

#pragma once

#include "source/row_lattice.h"
#include "source/winding_map.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <openvdb/math/BBox.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Where rows along x enter and leave the places that a surface with openings winds around: those
/// whose winding number is above WindingMap::kInside, in its box. Rows are kept in bundles, the
/// rows that pass through a square of kSide by kSide voxels.
///
/// Crossings at triangles are as exact as floats, counted from the first cell. In openings the
/// winding number is followed to the place where it is that, to a hundredth of a voxel or so. What
/// enters and leaves an opening within a cell of kSide voxels, hitting no triangle there, may be
/// missed.
class WindingRows {
  public:
    static constexpr int kSide = 4;

    /// Of a mesh whose points that belong together are one. Throws Error(ErrorKind::Memory),
    /// Error(ErrorKind::Interrupted).
    WindingRows(const WindingTree& tree, const openvdb::BBoxd& bounds, const RowLattice& lattice,
                Progress& progress);

    const RowLattice& lattice() const { return mLattice; }
    /// Along y and z; x is 1.
    openvdb::Coord bundleCount() const { return {1, mCells.count.y(), mCells.count.z()}; }
    /// The first voxel of a bundle along y and z.
    openvdb::Coord firstVoxel(std::int64_t bundle) const;
    /// The crossings of row i of a bundle's voxel, x rising, voxels: entering, leaving, entering, …
    std::span<const float> row(std::int64_t bundle, int y, int z, int i) const {
        const Bundle& b = mBundles[bundle];
        const std::size_t row = (static_cast<std::size_t>(y) * kSide + z) * mLattice.rowCount() + i;
        return {b.crossings.data() + b.start[row], b.crossings.data() + b.start[row + 1]};
    }
    /// The crossings of the only row of a voxel, which may lie outside of all bundles.
    std::span<const float> rowOfVoxel(int y, int z) const;
    bool isEmpty(std::int64_t bundle) const { return mBundles[bundle].crossings.empty(); }
    /// To be added to the crossings' x, voxels; a whole number.
    double xOrigin() const { return mXOrigin; }
    /// How many winding numbers were computed.
    std::int64_t evaluations() const { return mEvaluations; }

    /// Takes away what is inside of a closed mesh.
    void subtract(const Mesh& solid, Progress& progress);

  private:
    struct Bundle {
        std::vector<std::uint32_t> start;  // of each row in `crossings`, and the end
        std::vector<float> crossings;
    };

    RowLattice mLattice;
    CellLattice mCells;
    double mXOrigin;
    openvdb::Coord mFirstVoxel;
    std::vector<Bundle> mBundles;
    std::int64_t mEvaluations = 0;
};

}  // namespace bandvox

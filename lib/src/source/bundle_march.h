#pragma once

#include "source/winding_map.h"
#include "source/winding_rows.h"

#include <openvdb/math/BBox.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// Where a bundle of rows lies.
struct BundlePlace {
    RowLattice lattice;
    openvdb::Coord firstVoxel;  ///< along y and z
    double xOrigin;             ///< of places along x, voxels
};

/// Follows a bundle of rows along x through the cells of a map, and finds where they enter and
/// leave what the surface winds around.
class BundleMarch {
  public:
    /// Keeps references. `cell`: the bundle's, x is 0.
    BundleMarch(const WindingTree& tree, const WindingMap& map, const openvdb::BBoxd& bounds,
                const BundlePlace& place, const openvdb::Coord& cell);

    /// Sets the crossings of all rows, and where each row's begin.
    void run(std::vector<std::uint32_t>& start, std::vector<float>& crossings);

    std::int64_t evaluations() const { return mEvaluations; }

  private:
    // A row on its way. Places along x are voxels from the bundle's origin.
    struct Row {
        double y, z;  // world units
        bool isInside = false;
        double at = 0;       // so far it has been followed
        double winding = 0;  // there, if it is known
        bool isKnown = false;
        std::vector<float> crossings;
    };
    // A triangle in a row's way.
    struct Hit {
        std::int32_t row;
        double x;
        int leaving;
    };

    void passConstant(int x);
    void passMixed(int x);
    void findHits(double begin, double end);
    bool passSmooth(Row& row, std::span<const Hit> hits, double end);
    bool passLikely(Row& row, std::span<const Hit> hits, double end);
    void passRough(Row& row, std::span<const Hit> hits, double end);
    void leave(Row& row, double end);
    void sampleFace(double x);
    std::optional<bool> likelyAtEnd(const Row& row, double end);
    void cross(Row& row, double x);
    double findCrossing(const Row& row, double end, double windingAtEnd);
    double windingAt(const Row& row, double x);
    openvdb::Vec3d placeOf(const Row& row, double x) const {
        return {(mPlace.xOrigin + x) * mPlace.lattice.voxelSize, row.y, row.z};
    }

    const WindingTree& mTree;
    const WindingMap& mMap;
    BundlePlace mPlace;
    openvdb::Coord mCell;
    double mBegin, mEnd;  // of the surface's box along x
    std::vector<Row> mRows;
    std::vector<Hit> mHits;
    WindingTerms mTerms;
    std::optional<double> mFraction;    // of the winding number in a smooth cell
    std::vector<double> mFace;          // winding numbers where a cell ends, voxel by voxel, if any
    std::optional<bool> mNextIsInside;  // the cell that comes next, if it is constant
    std::int64_t mEvaluations = 0;
};

}  // namespace bandvox

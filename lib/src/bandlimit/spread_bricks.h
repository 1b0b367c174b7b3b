#pragma once

#include "bandlimit/element_bins.h"
#include "bandlimit/near_cells.h"
#include "bandlimit/parallel_bins.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// A surface of very many small elements, spread once for all tiles.
///
/// What matters to a tile reaches into its neighbours by the halo, so that on average each sample
/// is wanted by about two tiles. Space is cut where the region of any tile begins or ends, and
/// in between, into bricks, so that a region is made of whole ones; a brick's samples are spread to
/// a piece of lattice of its own, which tiles add to theirs. Only nodes that some sample
/// reaches are kept, so that memory follows the surface's area, not the number of elements.
class SpreadBricks {
  public:
    /// True if the elements are so many for the surface's area that this takes less time than
    /// spreading for each tile.
    static bool payFor(const BoundarySource& source, double voxelSize);

    /// Bytes that bricks take, about.
    static double estimateMemory(const BoundarySource& source, const TilePlan& plan,
                                 double voxelSize);

    /// The steps by which making them advances progress.
    static std::int64_t steps(const TilePlan& plan, const TileLayout& layout);

    /// For columns of tiles that are `wanted`, as fillColumns has them. Spreads nothing yet.
    SpreadBricks(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                 const TileFilter& filter, const std::vector<bool>& wanted);

    /// Spreads what matters to all of them. Throws Error(ErrorKind::Interrupted).
    SpreadBricks(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                 const TileFilter& filter, const std::vector<bool>& wanted, Progress& progress);

    /// Spreads what matters to tiles in some rows along y, unless that has been done. Throws
    /// Error(ErrorKind::Interrupted).
    void spread(const TileRange& rows, Progress& progress);

    /// Gives back what matters to no tile in row `row` or behind.
    void dropBefore(int row);

    /// Bytes that the bricks take.
    std::size_t memory() const { return mMemory; }

    /// What is in a tile's region.
    struct Content {
        std::int64_t samples = 0;
        bool hasDifferences = false;  ///< some sample's area vector has a part along x
    };
    Content contentOf(const openvdb::Coord& tile) const;

    /// Marks the voxels of a tile's region that hold samples (the interior's first voxel is
    /// `interiorAt` from the region's).
    void mark(const openvdb::Coord& tile, const openvdb::Coord& interiorAt, NearCells& near) const;

    /// Adds a tile's bricks to its buffer, as TileFilter::spread does their samples.
    void addTo(const openvdb::Coord& tile, float* buffer) const;

    /// True if any tile of a column has content.
    bool isInColumn(int y, int z) const;

    /// Seconds that spreading took, of all threads together.
    double spreadSeconds() const { return mSeconds; }

  private:
    /// Nodes of a brick in a row along z that hold something.
    struct Row {
        std::uint32_t value;              // of the first of them in mValues
        std::uint8_t x, y, begin, count;  // nodes
    };
    struct Brick {
        int alongX;  // which along x
        std::uint32_t samples = 0;
        bool hasDifferences = false;
        std::vector<Row> rows;
        std::vector<float> values;
        std::vector<std::uint16_t> voxels;  // that hold samples: x·32² + y·32 + z
        std::size_t memory() const;
    };
    using Column = std::vector<Brick>;  // from low x to high

    /// Where bricks begin along an axis, from where the first tile's region does.
    struct Axis {
        std::vector<int> cuts;     // and where the last one ends; voxels
        std::vector<int> brickOf;  // of each voxel
        int interior, side;
        Axis() = default;
        Axis(int tiles, int interiorOfTile, int sideOfTile);
        int count() const { return static_cast<int>(cuts.size()) - 1; }
        int first(int tile) const { return brickOf[tile * interior]; }
        int last(int tile) const { return brickOf[tile * interior + side - 1]; }
        int at(double place) const;
    };

    class Filler;

    Bins binElements(const std::vector<bool>& wantedBricks) const;
    std::size_t memoryOf(int y) const;
    std::vector<bool> bricksOf(const std::vector<bool>& wantedTiles) const;
    template <typename Visit>
    void forEachBrick(const openvdb::Coord& tile, const Visit& visit) const;

    const BoundarySource& mSource;
    const TilePlan& mPlan;
    const TileLayout& mLayout;
    const TileFilter& mFilter;
    openvdb::Vec3d mOrigin;  // of the first tile's region, voxels
    std::array<Axis, 3> mAxes;
    Bins mBins;                    // the elements of each column of bricks
    std::vector<Column> mColumns;  // y·(bricks along z) + z
    int mFirst = 0, mEnd = 0;      // along y, of the columns that are there
    std::size_t mMemory = 0;
    double mSeconds = 0;
};

}  // namespace bandvox

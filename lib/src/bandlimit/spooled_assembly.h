#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/far_tiles.h"
#include "bandlimit/finish_leaves.h"
#include "bandlimit/tile_plan.h"
#include "grid/leaf_spool.h"

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace bandvox {

/// Joins the columns of a grid as assembleGrid does, but takes them as they come: of what no column
/// to come has a share of, the values go to a file, and only what is active is kept.
class SpooledAssembly {
  public:
    /// Room for the values is taken beside `target`. `rounds`: to 16 bits, as roundToHalf does.
    /// Throws Error(ErrorKind::Runtime) if no file can be made there.
    SpooledAssembly(const TileLayout& layout, const AssemblyOptions& options, bool rounds,
                    const std::filesystem::path& target);
    SpooledAssembly(const SpooledAssembly&) = delete;
    SpooledAssembly& operator=(const SpooledAssembly&) = delete;

    /// Takes the next columns, in the order of the layout's (y, z). Throws
    /// Error(ErrorKind::Runtime) if there is no room for the values.
    void add(std::vector<ColumnBlocks> columns);

    /// Bytes that it holds, and that finish() and what is made of the grid need.
    double memory() const;
    double finalMemory() const;

    /// What finalMemory() comes to, at the least, for a grid that was estimated to have so many
    /// leaf nodes.
    static double leastFinalMemory(double leaves);

    /// A grid as assembleGrid makes it, whose values are elsewhere, and what is known of these.
    struct Grid {
        openvdb::FloatGrid::Ptr grid;
        double storedIntegral = 0;  ///< as densityIntegral has it
        double integral = 0;        ///< the same before values were rounded
        double storageError = 0;    ///< largest change by rounding
    };

    /// The grid, once all columns are there; `limit`: with values limited to [0, 1], even if the
    /// options did not ask for it. Empties this. Throws Error(ErrorKind::Runtime) if the file
    /// fails.
    Grid finish(bool limit);

  private:
    // What is kept of a leaf node; its number is its place in the list.
    struct Kept {
        openvdb::Coord origin;
        bool isBeyond = false;  // some value is not in [0, 1]
        DensityLeaf::NodeMaskType active;
        double sum = 0;        // of active values
        double storedSum = 0;  // the same of rounded ones
    };
    // A list in pieces, which grows without being copied and is given back piece by piece.
    class KeptList {
      public:
        static constexpr std::size_t kOfPiece = 4096;
        void resize(std::size_t size);
        Kept& operator[](std::size_t i) { return mPieces[i / kOfPiece][i % kOfPiece]; }
        std::size_t size() const { return mSize; }
        std::vector<std::vector<Kept>> take() { return std::move(mPieces); }

      private:
        std::vector<std::vector<Kept>> mPieces;
        std::size_t mSize = 0;
    };

    bool isComplete(const openvdb::Coord& block) const;
    LeafList takeComplete();
    void keep(LeafList leaves);
    void round(LeafList& leaves, std::vector<double>& sums);
    void limitKept();

    TileLayout mLayout;
    AssemblyOptions mOptions;
    bool mRounds;
    FarTiles mFar;
    std::int64_t mNext = 0;  // column
    LeafList mPending;       // pieces of blocks that go on in columns to come
    std::vector<ConstantBlock> mConstant;
    KeptList mKept;
    std::shared_ptr<LeafSpool> mSpool;
    // Largest change by rounding, of all values and of those in [0, 1].
    double mChange = 0, mChangeInside = 0;
    double mLost = 0;  // of the sum of all values, where rounding has made tiles
};

}  // namespace bandvox

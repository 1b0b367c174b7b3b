#pragma once

#include <bandvox/core/parallel.h>
#include <bandvox/core/progress.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace bandvox {

/// Places of a lattice in space, and vectors of numbers that belong to them, in blocks of 8 x 8 x
/// 8: control points of a sparse net, or cells. Cell i lies between the knots i and i + 1, and the
/// control points i to i + 3 count in it.
class SpaceNet {
  public:
    using Place = std::array<int, 3>;

    static constexpr int kSide = 8;
    static constexpr std::size_t kBlock = 512;  ///< places, [x][y][z]

    /// Adds the places (x, y, z + i) for which bit i of `bits` is set; z is a multiple of 8.
    void addRow(const Place& row, unsigned bits);
    void add(const Place& place) {
        addRow({place[0], place[1], place[2] & ~7}, 1U << (place[2] & 7));
    }

    bool contains(const Place& place) const;

    /// The number of blocks; a vector of numbers has 512 for each, 0 where there is no place.
    std::size_t blocks() const { return mBlocks.size(); }
    std::size_t numbers() const { return mBlocks.size() * kBlock; }
    /// The number of places.
    std::size_t count() const;

    /// The first place of a block.
    Place placeOf(std::size_t block) const;
    /// The bits along z of its rows, [x][y].
    const std::array<std::uint8_t, 64>& rowsOf(std::size_t block) const {
        return mBlocks[block].rows;
    }
    /// The block of a place, or -1.
    std::int32_t blockOf(const Place& place) const;

    /// Sorts the blocks, so that they do not depend on the order in which places were added. Needed
    /// before vectors are made.
    void sort();

    /// The control points that count in these cells.
    SpaceNet controlsOfCells(const Progress& progress = silentProgress()) const;

    /// The control points of a net with cells twice as wide that are needed for these.
    SpaceNet parents(const Progress& progress = silentProgress()) const;

    /// All places not farther than `reach` cells from one of these: boxes of the cells at their
    /// nearest, or where `surely`, at their farthest. `reach`: 0 to kMostReach.
    SpaceNet dilated(double reach, bool surely, const Progress& progress = silentProgress()) const;
    static constexpr double kMostReach = 22;

    /// Copies a cube of numbers, [x][y][z], from `from` on; `row` numbers lie between its rows
    /// along z, which are `side` long.
    void gather(std::span<const double> numbers, const Place& from, int side, int row,
                double* cube) const;

    /// Sets numbers to 0 where there is no place.
    void clearOutside(std::span<double> numbers) const;

  private:
    struct Block {
        std::uint64_t key;
        std::array<std::uint8_t, 64> rows;
    };

    std::vector<Block> mBlocks;
    std::unordered_map<std::uint64_t, std::int32_t> mIndex;
};

/// x = P y: what a coarse net's numbers are on the net whose parents it has.
void prolongSpace(const SpaceNet& coarse, const SpaceNet& fine, std::span<const double> y,
                  std::span<double> x);

/// y = P^T x.
void restrictSpace(const SpaceNet& coarse, const SpaceNet& fine, std::span<const double> x,
                   std::span<double> y);

}  // namespace bandvox

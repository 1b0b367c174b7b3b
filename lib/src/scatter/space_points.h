#pragma once

#include "scatter/space_net.h"

#include <bandvox/core/progress.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bandvox {

/// Points of a box whose longest side is 1, in an order in which those of a block of cells follow
/// each other, whatever the level.
struct SortedSpacePoints {
    /// 2^kFinest cells along the box at most.
    static constexpr int kFinest = 20;

    std::vector<std::array<double, 3>> at;  ///< 0 to 1
    std::vector<double> weight;             ///< above 0; how many points each stands for
    std::vector<std::uint32_t> origin;      ///< the index that each had before

    std::size_t size() const { return at.size(); }

    /// The cell of a level that holds point `i`.
    SpaceNet::Place cell(std::size_t i, int level) const;
};

SortedSpacePoints sortSpacePoints(std::vector<std::array<double, 3>> at,
                                  std::span<const double> weight);

/// The cells of a level that hold points, and which.
class OccupiedCells {
  public:
    OccupiedCells(const SortedSpacePoints& points, int level,
                  const Progress& progress = silentProgress());

    int level() const { return mLevel; }
    /// The points of a cell: from the first index to before the second.
    std::pair<std::uint32_t, std::uint32_t> pointsOf(const SpaceNet::Place& cell) const;
    /// The cells as places.
    SpaceNet places() const;

    /// The distance of point `i` to the nearest other one, in units of the box, or to what is
    /// farther than 8 cells.
    double nearest(std::size_t i) const;

    /// The points in cells that are, at their nearest, no farther than `reach` from a cell, in
    /// units of cells; those of near cells first.
    std::vector<std::uint32_t> pointsNear(const SpaceNet::Place& cell, double reach) const;

  private:
    const SortedSpacePoints& mPoints;
    int mLevel;
    using PointRange = std::pair<std::uint32_t, std::uint32_t>;
    std::unordered_map<std::uint64_t, PointRange> mCells;
    std::vector<PointRange> mInOrder;  // of all cells, as the points are sorted
};

/// How many cells of a level hold points.
std::size_t countOccupied(const SortedSpacePoints& points, int level);

/// How points act on a sparse net of a level, and the net on them.
class SpacePoints {
  public:
    /// Keeps references to both.
    SpacePoints(const SortedSpacePoints& points, const SpaceNet& net, int level);

    std::size_t size() const { return mPoints.size(); }

    /// values = A c: the field at each point.
    void evaluate(std::span<const double> net, std::span<double> values) const;

    /// net += A^T values.
    void spread(std::span<const double> values, std::span<double> net) const;

    /// net += A^T W A c, W the points' weights.
    void addNormal(std::span<const double> c, std::span<double> net) const;

    /// net += the diagonal of A^T W A.
    void addDiagonal(std::span<double> net) const;

  private:
    /// A block of cells that holds points.
    struct Part {
        SpaceNet::Place block;
        std::size_t begin, end;
        std::array<std::int32_t, 8> nets;  ///< its net's block and the next ones, or -1
    };

    template <typename Spread>
    void forPartsApart(std::span<double> net, const Spread& spread) const;

    const SortedSpacePoints& mPoints;
    const SpaceNet& mNet;
    double mCells;                            // along the box
    std::array<std::vector<Part>, 8> mParts;  // no two of one kind share control points
};

}  // namespace bandvox

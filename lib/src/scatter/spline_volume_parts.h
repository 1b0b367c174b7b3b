#pragma once

#include "scatter/space_net.h"
#include "scatter/space_points.h"

#include <bandvox/scatter/spline_volume.h>

#include <array>
#include <memory>
#include <vector>

namespace bandvox {

/// A net, and its control points for each column.
struct SpaceLayer {
    int level = 0;
    SpaceNet net;
    std::vector<std::vector<double>> control;
};

/// Bumps at the points, as SpaceBumps has them.
struct BumpLayer {
    int level = 0;
    std::vector<std::vector<double>> sizes;
};

/// What a volume is made of: the sum of its layers, in a box whose longest side is 1, for columns
/// of a mean of 0 and a range of 1.
struct SplineVolumeParts {
    std::array<double, 3> origin{};  ///< of the box, world units
    std::array<double, 3> size{};    ///< of the box, world units
    double longest = 1;              ///< of its sides
    double reach = 0;                ///< in units of the longest side
    std::vector<double> mean, range;
    std::unique_ptr<const SortedSpacePoints> sorted;  ///< what other members refer to
    std::vector<SpaceLayer> layers;
    std::vector<BumpLayer> bumps;
    std::unique_ptr<OccupiedCells> occupied;  ///< of the first layer's level
    SpaceNet near;                            ///< cells of that level that may have values
    SpaceNet sure;                            ///< and such as have them everywhere

    const SortedSpacePoints& points() const { return *sorted; }

    std::array<double, 3> unitPlace(const openvdb::Vec3d& place) const {
        return {(place[0] - origin[0]) / longest, (place[1] - origin[1]) / longest,
                (place[2] - origin[2]) / longest};
    }
};

/// Tells whether there is a point within reach of a place. What is known of some cells is kept. For
/// one thread.
class ReachReader {
  public:
    explicit ReachReader(const SplineVolumeParts& parts);
    bool covers(const std::array<double, 3>& at);

  private:
    struct Cell {
        SpaceNet::Place place;
        bool isNear, isSure;
        std::vector<std::uint32_t> points;  ///< that may be near, if it is not sure
    };
    const Cell& cellOf(const SpaceNet::Place& place);

    const SplineVolumeParts& mParts;
    double mCells;
    std::vector<Cell> mKnown;
    std::size_t mNext = 0;  // to be replaced
    std::size_t mLast = 0;  // looked up before
};

/// Reads a layer's values. What is around the last place is kept, so that places near each other
/// are read fast. For one thread.
class LayerReader {
  public:
    explicit LayerReader(const SpaceLayer& layer);

    /// Adds to each column's value at a place.
    void addTo(const std::array<double, 3>& at, double* values);

    /// Adds to each column's gradient, [column][axis], by units of the longest side.
    void addGradientTo(const std::array<double, 3>& at, double* gradients);

  private:
    /// Finds the cell, and has the control points around it at hand; the first that counts.
    std::size_t find(const std::array<double, 3>& at);
    double sum(std::size_t column, std::size_t first,
               const std::array<std::array<double, 4>, 3>& weights) const;

    const SpaceLayer& mLayer;
    double mCells;
    SpaceNet::Place mBlock{};
    std::array<double, 3> mPlace{};           // in the cell
    std::vector<std::vector<double>> mCubes;  // empty before the first place
};

}  // namespace bandvox

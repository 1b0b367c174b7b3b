#include "scatter/space_points.h"

#include "scatter/cubic_basis.h"

#include <cmath>
#include <numeric>

namespace bandvox {
namespace {

constexpr int kReachSide = SpaceNet::kSide + 3;
using ReachCube =
    std::array<double, static_cast<std::size_t>(kReachSide) * kReachSide * kReachSide>;

/// Spreads the bits of a number three apart.
std::uint64_t spreadByThree(std::uint64_t bits) {
    bits = (bits | bits << 32U) & 0x1F00000000FFFFULL;
    bits = (bits | bits << 16U) & 0x1F0000FF0000FFULL;
    bits = (bits | bits << 8U) & 0x100F00F00F00F00FULL;
    bits = (bits | bits << 4U) & 0x10C30C30C30C30C3ULL;
    return (bits | bits << 2U) & 0x1249249249249249ULL;
}

int cellAlong(double place, double cells) {
    return static_cast<int>(std::clamp(place * cells, 0.0, cells - 1));
}

/// Where a point lies in the cube of a block: its first control point, and the weights.
struct ReachPlace {
    int first;
    std::array<std::array<double, 4>, 3> weights;

    ReachPlace(const std::array<double, 3>& at, const SpaceNet::Place& block, double cells)
        : first(0) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int cell = cellAlong(at[axis], cells);
            weights[axis] = cubicWeights(at[axis] * cells - cell);
            first = first * kReachSide + cell - block[axis];
        }
    }
};

double reachValue(const ReachPlace& place, const ReachCube& cube) {
    double sum = 0;
    for (int x = 0; x < 4; ++x) {
        double sheet = 0;
        for (int y = 0; y < 4; ++y) {
            const double* const row = cube.data() + place.first + (x * kReachSide + y) * kReachSide;
            const auto& z = place.weights[2];
            sheet += place.weights[1][static_cast<std::size_t>(y)] *
                     (row[0] * z[0] + row[1] * z[1] + row[2] * z[2] + row[3] * z[3]);
        }
        sum += place.weights[0][static_cast<std::size_t>(x)] * sheet;
    }
    return sum;
}

void addReachValue(const ReachPlace& place, double value, ReachCube& cube) {
    for (int x = 0; x < 4; ++x) {
        const double sheet = value * place.weights[0][static_cast<std::size_t>(x)];
        for (int y = 0; y < 4; ++y) {
            const double line = sheet * place.weights[1][static_cast<std::size_t>(y)];
            double* const row = cube.data() + place.first + (x * kReachSide + y) * kReachSide;
            for (std::size_t z = 0; z < 4; ++z) row[z] += line * place.weights[2][z];
        }
    }
}

}  // namespace

SpaceNet::Place SortedSpacePoints::cell(std::size_t i, int level) const {
    const double cells = std::ldexp(1.0, level);
    return {cellAlong(at[i][0], cells), cellAlong(at[i][1], cells), cellAlong(at[i][2], cells)};
}

SortedSpacePoints sortSpacePoints(std::vector<std::array<double, 3>> at,
                                  std::span<const double> weight) {
    // The order of G. M. Morton, by the bits of the three coordinates in turn.
    struct Entry {
        std::uint64_t key;
        std::uint32_t index;
    };
    std::vector<Entry> entries(at.size());
    const double cells = std::ldexp(1.0, SortedSpacePoints::kFinest);
    for (std::size_t i = 0; i < at.size(); ++i) {
        std::uint64_t key = 0;
        for (const double place : at[i]) {
            key = key << 1U | spreadByThree(static_cast<std::uint64_t>(cellAlong(place, cells)));
        }
        entries[i] = {key, static_cast<std::uint32_t>(i)};
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
    SortedSpacePoints points;
    for (const Entry& entry : entries) {
        points.at.push_back(at[entry.index]);
        points.weight.push_back(weight[entry.index]);
        points.origin.push_back(entry.index);
    }
    return points;
}

SpacePoints::SpacePoints(const SortedSpacePoints& points, const SpaceNet& net, int level)
    : mPoints(points), mNet(net), mCells(std::ldexp(1.0, level)) {
    const auto blockOfPoint = [&](std::size_t i) {
        const SpaceNet::Place cell = points.cell(i, level);
        return SpaceNet::Place{cell[0] & ~7, cell[1] & ~7, cell[2] & ~7};
    };
    for (std::size_t begin = 0; begin < points.size();) {
        Part part{blockOfPoint(begin), begin, begin + 1, {}};
        while (part.end < points.size() && blockOfPoint(part.end) == part.block) ++part.end;
        begin = part.end;
        std::size_t kind = 0;
        for (const int at : part.block) kind = 2 * kind + static_cast<std::size_t>(at >> 3 & 1);
        bool isJoined = false;
        for (int k = 0; k < 8; ++k) {
            const std::int32_t other = net.blockOf({part.block[0] + (k >> 2) * SpaceNet::kSide,
                                                    part.block[1] + (k >> 1 & 1) * SpaceNet::kSide,
                                                    part.block[2] + (k & 1) * SpaceNet::kSide});
            part.nets[static_cast<std::size_t>(k)] = other;
            isJoined = isJoined || other >= 0;
        }
        if (isJoined) mParts[kind].push_back(part);
    }
}

void SpacePoints::evaluate(std::span<const double> net, std::span<double> values) const {
    std::fill(values.begin(), values.end(), 0.0);
    for (const auto& parts : mParts) {
        parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t p) {
            const Part& part = parts[static_cast<std::size_t>(p)];
            ReachCube cube;
            mNet.gather(net, part.block, kReachSide, kReachSide, cube.data());
            for (std::size_t i = part.begin; i < part.end; ++i) {
                values[i] = reachValue(ReachPlace(mPoints.at[i], part.block, mCells), cube);
            }
        });
    }
}

/// Calls spread(part, cube) for every part, and adds the cube that it fills to the net.
template <typename Spread>
void SpacePoints::forPartsApart(std::span<double> net, const Spread& spread) const {
    for (const auto& parts : mParts) {
        parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t p) {
            const Part& part = parts[static_cast<std::size_t>(p)];
            ReachCube cube{};
            spread(part, cube);
            for (std::size_t k = 0; k < 8; ++k) {
                if (part.nets[k] < 0) continue;
                double* const to =
                    net.data() + static_cast<std::size_t>(part.nets[k]) * SpaceNet::kBlock;
                const int dx = (k & 4U) != 0 ? SpaceNet::kSide : 0;
                const int dy = (k & 2U) != 0 ? SpaceNet::kSide : 0;
                const int dz = (k & 1U) != 0 ? SpaceNet::kSide : 0;
                for (int x = dx; x < std::min(dx + SpaceNet::kSide, kReachSide); ++x) {
                    for (int y = dy; y < std::min(dy + SpaceNet::kSide, kReachSide); ++y) {
                        const double* const row =
                            cube.data() + (x * kReachSide + y) * kReachSide + dz;
                        double* const out =
                            to + ((x - dx) * SpaceNet::kSide + y - dy) * SpaceNet::kSide;
                        const int count = std::min(SpaceNet::kSide, kReachSide - dz);
                        for (int z = 0; z < count; ++z) out[z] += row[z];
                    }
                }
            }
        });
    }
    mNet.clearOutside(net);
}

void SpacePoints::spread(std::span<const double> values, std::span<double> net) const {
    forPartsApart(net, [&](const Part& part, ReachCube& cube) {
        for (std::size_t i = part.begin; i < part.end; ++i) {
            addReachValue(ReachPlace(mPoints.at[i], part.block, mCells), values[i], cube);
        }
    });
}

void SpacePoints::addNormal(std::span<const double> c, std::span<double> net) const {
    forPartsApart(net, [&](const Part& part, ReachCube& cube) {
        ReachCube from;
        mNet.gather(c, part.block, kReachSide, kReachSide, from.data());
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const ReachPlace place(mPoints.at[i], part.block, mCells);
            addReachValue(place, mPoints.weight[i] * reachValue(place, from), cube);
        }
    });
}

void SpacePoints::addDiagonal(std::span<double> net) const {
    forPartsApart(net, [&](const Part& part, ReachCube& cube) {
        for (std::size_t i = part.begin; i < part.end; ++i) {
            ReachPlace place(mPoints.at[i], part.block, mCells);
            for (auto& weights : place.weights) {
                for (double& weight : weights) weight *= weight;
            }
            addReachValue(place, mPoints.weight[i], cube);
        }
    });
}

}  // namespace bandvox

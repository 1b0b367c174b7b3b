#include "scatter/cubic_basis.h"
#include "scatter/space_bumps.h"
#include "scatter/spline_volume_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

// A block of cells, and the control points that count in them.
constexpr int kReaderSide = SpaceNet::kSide + 3;
constexpr std::size_t kReaderNumbers =
    static_cast<std::size_t>(kReaderSide) * kReaderSide * kReaderSide;

/// Calls body(offset, radius, point) for the points whose bumps a place may be in.
template <typename Body>
void forBumpsAt(const SplineVolumeParts& parts, const BumpLayer& bumps,
                const std::array<double, 3>& at, const Body& body) {
    // A bump reaches as far as a cell of its level, which is narrower than those of the net.
    const double radius = std::ldexp(1.0, -bumps.level);
    const double cells = std::ldexp(1.0, parts.occupied->level());
    SpaceNet::Place first{}, last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto cellOf = [&](double x) {
            return static_cast<int>(std::clamp(std::floor(x * cells), 0.0, cells - 1));
        };
        first[axis] = cellOf(at[axis] - radius);
        last[axis] = cellOf(at[axis] + radius);
    }
    for (int x = first[0]; x <= last[0]; ++x) {
        for (int y = first[1]; y <= last[1]; ++y) {
            for (int z = first[2]; z <= last[2]; ++z) {
                const auto [begin, end] = parts.occupied->pointsOf({x, y, z});
                for (std::size_t i = begin; i < end; ++i) {
                    const auto& p = parts.points().at[i];
                    const std::array<double, 3> offset{at[0] - p[0], at[1] - p[1], at[2] - p[2]};
                    body(offset, radius, i);
                }
            }
        }
    }
}

}  // namespace

LayerReader::LayerReader(const SpaceLayer& layer)
    : mLayer(layer), mCells(std::ldexp(1.0, layer.level)) {}

std::size_t LayerReader::find(const std::array<double, 3>& at) {
    SpaceNet::Place cell{}, block{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cell[axis] = static_cast<int>(std::floor(at[axis] * mCells));
        mPlace[axis] = at[axis] * mCells - cell[axis];
        block[axis] = cell[axis] & ~7;
    }
    if (mCubes.empty() || block != mBlock) {
        mBlock = block;
        mCubes.resize(mLayer.control.size(), std::vector<double>(kReaderNumbers));
        for (std::size_t c = 0; c < mCubes.size(); ++c) {
            mLayer.net.gather(mLayer.control[c], block, kReaderSide, kReaderSide, mCubes[c].data());
        }
    }
    return static_cast<std::size_t>(((cell[0] - block[0]) * kReaderSide + cell[1] - block[1]) *
                                        kReaderSide +
                                    cell[2] - block[2]);
}

double LayerReader::sum(std::size_t column, std::size_t first,
                        const std::array<std::array<double, 4>, 3>& weights) const {
    double sum = 0;
    const auto& z = weights[2];
    for (std::size_t x = 0; x < 4; ++x) {
        double sheet = 0;
        for (std::size_t y = 0; y < 4; ++y) {
            const double* const row =
                mCubes[column].data() + first + (x * kReaderSide + y) * kReaderSide;
            sheet +=
                weights[1][y] * (row[0] * z[0] + row[1] * z[1] + row[2] * z[2] + row[3] * z[3]);
        }
        sum += weights[0][x] * sheet;
    }
    return sum;
}

void LayerReader::addTo(const std::array<double, 3>& at, double* values) {
    const std::size_t first = find(at);
    const std::array<std::array<double, 4>, 3> weights{
        cubicWeights(mPlace[0]), cubicWeights(mPlace[1]), cubicWeights(mPlace[2])};
    for (std::size_t c = 0; c < mCubes.size(); ++c) values[c] += sum(c, first, weights);
}

void LayerReader::addGradientTo(const std::array<double, 3>& at, double* gradients) {
    const std::size_t first = find(at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<std::array<double, 4>, 3> weights;
        for (std::size_t a = 0; a < 3; ++a) weights[a] = cubicWeights(mPlace[a], a == axis ? 1 : 0);
        for (std::size_t c = 0; c < mCubes.size(); ++c) {
            gradients[3 * c + axis] += mCells * sum(c, first, weights);
        }
    }
}

ReachReader::ReachReader(const SplineVolumeParts& parts)
    : mParts(parts), mCells(std::ldexp(1.0, parts.occupied->level())) {}

const ReachReader::Cell& ReachReader::cellOf(const SpaceNet::Place& place) {
    // Voxels of a row are in the same cell mostly.
    if (!mKnown.empty() && mKnown[mLast].place == place) return mKnown[mLast];
    for (std::size_t i = 0; i < mKnown.size(); ++i) {
        if (mKnown[i].place == place) return mKnown[mLast = i];
    }
    Cell found{place, mParts.near.contains(place), false, {}};
    found.isSure = found.isNear && mParts.sure.contains(place);
    if (found.isNear && !found.isSure) {
        found.points = mParts.occupied->pointsNear(place, mParts.reach * mCells);
    }
    // As many as a block of voxels meets if these are smaller than cells.
    constexpr std::size_t kMostKnown = 8;
    if (mKnown.size() < kMostKnown) {
        mLast = mKnown.size();
        return mKnown.emplace_back(std::move(found));
    }
    mLast = mNext++ % kMostKnown;
    return mKnown[mLast] = std::move(found);
}

bool ReachReader::covers(const std::array<double, 3>& at) {
    SpaceNet::Place place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = static_cast<int>(std::floor(at[axis] * mCells));
    }
    const Cell& cell = cellOf(place);
    if (!cell.isNear || cell.isSure) return cell.isNear;
    return std::any_of(cell.points.begin(), cell.points.end(), [&](std::uint32_t i) {
        const auto& point = mParts.points().at[i];
        const double x = at[0] - point[0];
        const double y = at[1] - point[1];
        const double z = at[2] - point[2];
        return x * x + y * y + z * z <= mParts.reach * mParts.reach;
    });
}

int SplineVolume::columns() const {
    return static_cast<int>(mParts->mean.size());
}

openvdb::BBoxd SplineVolume::bounds() const {
    const auto& [x, y, z] = mParts->origin;
    const auto& [width, depth, height] = mParts->size;
    return {{x, y, z}, {x + width, y + depth, z + height}};
}

double SplineVolume::reach() const {
    return mParts->reach * mParts->longest;
}

std::size_t SplineVolume::controlPoints() const {
    std::size_t sum = 0;
    for (const SpaceLayer& layer : mParts->layers) sum += layer.net.count();
    return sum;
}

bool SplineVolume::covers(const openvdb::Vec3d& place) const {
    return ReachReader(*mParts).covers(mParts->unitPlace(place));
}

double SplineVolume::value(const openvdb::Vec3d& place, int column) const {
    const SplineVolumeParts& parts = *mParts;
    const std::array<double, 3> at = parts.unitPlace(place);
    std::vector<double> values(parts.mean.size());
    for (const SpaceLayer& layer : parts.layers) LayerReader(layer).addTo(at, values.data());
    const auto c = static_cast<std::size_t>(column);
    for (const BumpLayer& bumps : parts.bumps) {
        forBumpsAt(parts, bumps, at, [&](const auto& offset, double radius, std::size_t i) {
            values[c] += bumps.sizes[c][i] * bumpHeight(offset, radius);
        });
    }
    return parts.mean[c] + parts.range[c] * values[c];
}

openvdb::Vec3d SplineVolume::gradient(const openvdb::Vec3d& place, int column) const {
    const SplineVolumeParts& parts = *mParts;
    const std::array<double, 3> at = parts.unitPlace(place);
    std::vector<double> gradients(3 * parts.mean.size());
    for (const SpaceLayer& layer : parts.layers) {
        LayerReader(layer).addGradientTo(at, gradients.data());
    }
    const auto c = static_cast<std::size_t>(column);
    openvdb::Vec3d sum(gradients[3 * c], gradients[3 * c + 1], gradients[3 * c + 2]);
    for (const BumpLayer& bumps : parts.bumps) {
        forBumpsAt(parts, bumps, at, [&](const auto& offset, double radius, std::size_t i) {
            sum += bumps.sizes[c][i] * openvdb::Vec3d(bumpGradient(offset, radius).data());
        });
    }
    return parts.range[c] / parts.longest * sum;
}

}  // namespace bandvox

#include "core/words.h"
#include "scatter/space_bumps.h"
#include "scatter/spline_volume_parts.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/scatter/spline_volume_to_grids.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace bandvox {
namespace {

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using VectorLeaf = openvdb::Vec3STree::LeafNodeType;

/// The values of the voxels of a leaf, and which there are.
struct SampledLeaf {
    openvdb::Coord origin;
    FloatLeaf::NodeMaskType active;
    // Of each column, and with gradients then three of each: [number][voxel]; empty if none is
    // active.
    std::vector<float> values;
};

/// The leaves that the cells which may have values meet.
std::vector<openvdb::Coord> leavesNear(const SplineVolumeParts& parts, double voxelSize) {
    // Blocks of cells, or of voxels if these are larger: each leaf is found once.
    const double cell = std::ldexp(parts.longest, -parts.occupied->level());
    SpaceNet leaves;  // its places are leaves
    for (std::size_t block = 0; block < parts.near.blocks(); ++block) {
        const SpaceNet::Place from = parts.near.placeOf(block);
        std::array<std::array<int, 2>, 3> range{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = parts.origin[axis] + cell * from[axis];
            const auto voxelOf = [&](double place) {
                return static_cast<int>(std::floor(place / voxelSize + 0.5));
            };
            range[axis] = {voxelOf(low) >> 3, voxelOf(low + cell * SpaceNet::kSide) >> 3};
        }
        for (int x = range[0][0]; x <= range[0][1]; ++x) {
            for (int y = range[1][0]; y <= range[1][1]; ++y) {
                for (int z = range[2][0]; z <= range[2][1]; ++z) leaves.add({x, y, z});
            }
        }
    }
    leaves.sort();
    std::vector<openvdb::Coord> found;
    for (std::size_t block = 0; block < leaves.blocks(); ++block) {
        const SpaceNet::Place at = leaves.placeOf(block);
        for (int i = 0; i < static_cast<int>(SpaceNet::kBlock); ++i) {
            openvdb::Coord leaf(at[0] + i / 64, at[1] + i / 8 % 8, at[2] + i % 8);
            if (leaves.contains({leaf[0], leaf[1], leaf[2]}))
                found.push_back(openvdb::Coord(leaf[0] * 8, leaf[1] * 8, leaf[2] * 8));
        }
    }
    return found;
}

/// Samples leaves, for one thread.
class LeafSampler {
  public:
    LeafSampler(const SplineVolumeParts& parts, double voxelSize, bool hasGradients)
        : mParts(parts),
          mVoxelSize(voxelSize),
          mColumns(parts.mean.size()),
          mNumbers(hasGradients ? 4 * mColumns : mColumns),
          mReach(parts) {
        for (const SpaceLayer& layer : parts.layers) mReaders.emplace_back(layer);
    }

    SampledLeaf sample(const openvdb::Coord& origin) {
        SampledLeaf leaf{origin, {}, {}};
        std::vector<double> values(mNumbers * FloatLeaf::SIZE);
        std::vector<double> one(mNumbers);
        for (openvdb::Index i = 0; i < FloatLeaf::SIZE; ++i) {
            const std::array<double, 3> at = placeOf(origin + FloatLeaf::offsetToLocalCoord(i));
            if (!mReach.covers(at)) continue;
            leaf.active.setOn(i);
            std::fill(one.begin(), one.end(), 0.0);
            for (LayerReader& reader : mReaders) {
                reader.addTo(at, one.data());
                if (mNumbers > mColumns) reader.addGradientTo(at, one.data() + mColumns);
            }
            for (std::size_t n = 0; n < mNumbers; ++n) values[n * FloatLeaf::SIZE + i] = one[n];
        }
        if (leaf.active.isOff()) return leaf;
        for (const BumpLayer& bumps : mParts.bumps) addBumps(bumps, origin, values);
        leaf.values.resize(values.size());
        for (std::size_t k = 0; k < values.size(); ++k) {
            const std::size_t n = k / FloatLeaf::SIZE;
            if (!leaf.active.isOn(static_cast<openvdb::Index>(k % FloatLeaf::SIZE))) continue;
            leaf.values[k] = static_cast<float>(inWorld(n, values[k]));
        }
        return leaf;
    }

  private:
    /// A number of a box of unit size and columns of unit range, in world units.
    double inWorld(std::size_t n, double value) const {
        if (n < mColumns) return mParts.mean[n] + mParts.range[n] * value;
        return mParts.range[(n - mColumns) / 3] / mParts.longest * value;
    }

    std::array<double, 3> placeOf(const openvdb::Coord& voxel) const {
        return mParts.unitPlace(voxel.asVec3d() * mVoxelSize);
    }

    void addBumps(const BumpLayer& bumps, const openvdb::Coord& origin,
                  std::vector<double>& values) const {
        const double radius = std::ldexp(1.0, -bumps.level);
        const double voxel = mVoxelSize / mParts.longest;
        const std::array<double, 3> low = placeOf(origin);
        const double cells = std::ldexp(1.0, mParts.occupied->level());
        SpaceNet::Place first{}, last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto cellOf = [&](double at) {
                return static_cast<int>(std::clamp(std::floor(at * cells), 0.0, cells - 1));
            };
            first[axis] = cellOf(low[axis] - radius);
            last[axis] = cellOf(low[axis] + 7 * voxel + radius);
        }
        for (int x = first[0]; x <= last[0]; ++x) {
            for (int y = first[1]; y <= last[1]; ++y) {
                for (int z = first[2]; z <= last[2]; ++z) {
                    const auto [begin, end] = mParts.occupied->pointsOf({x, y, z});
                    for (std::size_t i = begin; i < end; ++i) {
                        addBump(bumps, i, radius, low, voxel, values);
                    }
                }
            }
        }
    }

    void addBump(const BumpLayer& bumps, std::size_t point, double radius,
                 const std::array<double, 3>& low, double voxel,
                 std::vector<double>& values) const {
        const auto& at = mParts.points().at[point];
        std::array<std::array<int, 2>, 3> range{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double middle = (at[axis] - low[axis]) / voxel;
            const double half = radius / voxel;
            range[axis] = {static_cast<int>(std::ceil(std::clamp(middle - half, 0.0, 8.0))),
                           static_cast<int>(std::floor(std::clamp(middle + half, -1.0, 7.0)))};
        }
        for (int x = range[0][0]; x <= range[0][1]; ++x) {
            for (int y = range[1][0]; y <= range[1][1]; ++y) {
                for (int z = range[2][0]; z <= range[2][1]; ++z) {
                    const std::array<double, 3> offset{low[0] + x * voxel - at[0],
                                                       low[1] + y * voxel - at[1],
                                                       low[2] + z * voxel - at[2]};
                    const double height = bumpHeight(offset, radius);
                    const openvdb::Index i = FloatLeaf::coordToOffset(openvdb::Coord(x, y, z));
                    for (std::size_t c = 0; c < mColumns; ++c) {
                        values[c * FloatLeaf::SIZE + i] += height * bumps.sizes[c][point];
                    }
                    if (mNumbers == mColumns) continue;
                    const auto slope = bumpGradient(offset, radius);
                    for (std::size_t n = 0; n < 3 * mColumns; ++n) {
                        values[(mColumns + n) * FloatLeaf::SIZE + i] +=
                            slope[n % 3] * bumps.sizes[n / 3][point];
                    }
                }
            }
        }
    }

    const SplineVolumeParts& mParts;
    double mVoxelSize;
    std::size_t mColumns, mNumbers;
    ReachReader mReach;
    std::vector<LayerReader> mReaders;
};

std::vector<SampledLeaf> sampleLeaves(const SplineVolumeParts& parts, double voxelSize,
                                      bool hasGradients, Progress& progress) {
    const std::vector<openvdb::Coord> origins = leavesNear(parts, voxelSize);
    const double bytes = static_cast<double>(origins.size()) * FloatLeaf::SIZE * sizeof(float) *
                         static_cast<double>(parts.mean.size()) * (hasGradients ? 4 : 1);
    // They exist once as they are sampled, and once in the grids.
    requireMemory(2 * bytes, "the voxels in reach of the points");
    std::vector<SampledLeaf> leaves(origins.size());
    constexpr std::size_t kLeavesInPiece = 64;
    const std::size_t pieces = (origins.size() + kLeavesInPiece - 1) / kLeavesInPiece;
    const ProgressStage stage(progress, "sampling", static_cast<std::int64_t>(pieces));
    parallelFor(static_cast<std::int64_t>(pieces), [&](std::int64_t p) {
        progress.throwIfInterrupted();
        LeafSampler sampler(parts, voxelSize, hasGradients);
        const std::size_t begin = static_cast<std::size_t>(p) * kLeavesInPiece;
        for (std::size_t i = begin; i < std::min(begin + kLeavesInPiece, origins.size()); ++i) {
            leaves[i] = sampler.sample(origins[i]);
        }
        progress.advance();
    });
    return leaves;
}

openvdb::FloatGrid::Ptr floatGrid(const std::vector<SampledLeaf>& leaves, int column) {
    auto grid = openvdb::FloatGrid::create(0);
    const std::size_t from = static_cast<std::size_t>(column) * FloatLeaf::SIZE;
    for (const SampledLeaf& sampled : leaves) {
        if (sampled.values.empty()) continue;
        auto* const leaf = new FloatLeaf(sampled.origin, 0.0F);
        for (auto i = sampled.active.beginOn(); i; ++i) {
            leaf->setValueOn(i.pos(), sampled.values[from + i.pos()]);
        }
        grid->tree().addLeaf(leaf);
    }
    return grid;
}

openvdb::Vec3SGrid::Ptr vectorGrid(const std::vector<SampledLeaf>& leaves, const ColumnGrid& wanted,
                                   int columns) {
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    grid->setVectorType(wanted.type);
    const int first = wanted.isGradient ? columns + 3 * wanted.column : wanted.column;
    const std::size_t from = static_cast<std::size_t>(first) * FloatLeaf::SIZE;
    for (const SampledLeaf& sampled : leaves) {
        if (sampled.values.empty()) continue;
        auto* const leaf = new VectorLeaf(sampled.origin, openvdb::Vec3f(0));
        for (auto i = sampled.active.beginOn(); i; ++i) {
            const std::size_t at = from + i.pos();
            leaf->setValueOn(i.pos(), {sampled.values[at], sampled.values[at + FloatLeaf::SIZE],
                                       sampled.values[at + 2 * FloatLeaf::SIZE]});
        }
        grid->tree().addLeaf(leaf);
    }
    return grid;
}

}  // namespace

openvdb::GridPtrVec splineVolumeToGrids(const SplineVolume& volume,
                                        const std::vector<ColumnGrid>& grids, double voxelSize,
                                        Progress& progress) {
    if (!(voxelSize > 0) || !std::isfinite(voxelSize)) {
        throw Error(ErrorKind::Usage,
                    "voxels have a side of " + inShort(voxelSize) + "; expected more than 0");
    }
    for (const ColumnGrid& grid : grids) {
        const bool isThere = grid.column >= 0 && (grid.columns == 1 || grid.columns == 3) &&
                             grid.column + grid.columns <= volume.columns() &&
                             (grid.columns == 1 || !grid.isGradient);
        if (isThere) continue;
        throw Error(ErrorKind::Usage, "a grid takes " + std::to_string(grid.columns) +
                                          " columns from " + std::to_string(grid.column) +
                                          " on; expected 1 or 3 of " +
                                          std::to_string(volume.columns()));
    }
    const openvdb::BBoxd box = volume.bounds();
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        farthest = std::max({farthest, std::abs(box.min()[axis]), std::abs(box.max()[axis])});
    }
    constexpr double kMostVoxels = 1 << 28U;
    if (!((farthest + volume.reach()) / voxelSize < kMostVoxels)) {
        throw Error(ErrorKind::Usage, "voxels of side " + inShort(voxelSize) +
                                          " have indices beyond 2^28; expected larger ones");
    }
    const bool hasGradients = std::any_of(grids.begin(), grids.end(),
                                          [](const ColumnGrid& grid) { return grid.isGradient; });
    const std::vector<SampledLeaf> leaves =
        sampleLeaves(volume.parts(), voxelSize, hasGradients, progress);
    const bool isEmpty = std::all_of(leaves.begin(), leaves.end(),
                                     [](const SampledLeaf& leaf) { return leaf.values.empty(); });
    if (isEmpty) {
        throw Error(ErrorKind::Result, "no voxel of side " + inShort(voxelSize) +
                                           " has its centre within " + inShort(volume.reach()) +
                                           " of a point; expected smaller ones");
    }
    openvdb::GridPtrVec result;
    for (const ColumnGrid& wanted : grids) {
        openvdb::GridBase::Ptr grid;
        if (wanted.columns == 1 && !wanted.isGradient) {
            grid = floatGrid(leaves, wanted.column);
        } else {
            grid = vectorGrid(leaves, wanted, volume.columns());
        }
        grid->setName(wanted.name);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
        result.push_back(grid);
    }
    return result;
}

}  // namespace bandvox

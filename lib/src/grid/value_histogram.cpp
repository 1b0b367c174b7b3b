#include "grid/summary_values.h"

#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr std::size_t kLeavesPerVisit = 512;

double voxelsIn(const openvdb::CoordBBox& box) {
    if (box.empty()) return 0;
    double voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
        voxels *= static_cast<double>(box.max()[axis]) - box.min()[axis] + 1;
    }
    return voxels;
}

struct Extent {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();

    void include(float value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

// The voxels in the box of active ones, leaf by leaf and tile by tile.
class BoxedValues {
  public:
    explicit BoxedValues(const openvdb::FloatGrid& grid)
        : mBox(requireActiveBox(grid)), mBackground(finiteBackground(grid)) {
        grid.tree().getNodes(mLeaves);
        double voxels = 0;
        auto tile = grid.tree().cbeginValueAll();
        tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
        for (; tile; ++tile) {
            openvdb::CoordBBox part = tile.getBoundingBox();
            part.intersect(mBox);
            const double count = voxelsIn(part);
            voxels += count;
            const float value = finiteOr(*tile, mBackground);
            if (count == 0) continue;
            if (!tile.isValueOn() && value == mBackground) {
                mBackgroundVoxels += count;
            } else {
                mTiles.push_back({value, count, tile.isValueOn()});
            }
        }
        for (const Leaf* leaf : mLeaves) {
            openvdb::CoordBBox part = leaf->getNodeBoundingBox();
            part.intersect(mBox);
            voxels += voxelsIn(part);
        }
        // What no node of the tree covers.
        mBackgroundVoxels += voxelsIn(mBox) - voxels;
    }

    std::size_t tasks() const { return (mLeaves.size() + kLeavesPerVisit - 1) / kLeavesPerVisit; }

    /// Calls visit(value, isActive) for all voxels of a task's leaves that are in the box.
    template <typename Visitor>
    void visitLeaves(std::size_t task, const Visitor& visit) const {
        const std::size_t end = std::min((task + 1) * kLeavesPerVisit, mLeaves.size());
        for (std::size_t i = task * kLeavesPerVisit; i < end; ++i) {
            const Leaf& leaf = *mLeaves[i];
            const bool isWhole = mBox.isInside(leaf.getNodeBoundingBox());
            const float* values = leaf.buffer().data();
            for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
                if (!isWhole && !mBox.isInside(leaf.offsetToGlobalCoord(n))) continue;
                visit(finiteOr(values[n], mBackground), leaf.isValueOn(n));
            }
        }
    }

    /// Calls visit(value, isActive, voxels) for all that no leaf holds.
    template <typename Visitor>
    void visitTiles(const Visitor& visit) const {
        for (const Tile& tile : mTiles) visit(tile.value, tile.isActive, tile.voxels);
        if (mBackgroundVoxels > 0) visit(mBackground, false, mBackgroundVoxels);
    }

  private:
    struct Tile {
        float value;
        double voxels;
        bool isActive;
    };
    openvdb::CoordBBox mBox;
    float mBackground;
    std::vector<const Leaf*> mLeaves;
    std::vector<Tile> mTiles;
    double mBackgroundVoxels = 0;
};

Extent extentOf(const BoxedValues& values, const Progress& progress) {
    std::vector<Extent> found(values.tasks());
    parallelFor(static_cast<std::int64_t>(found.size()), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        Extent extent;
        values.visitLeaves(static_cast<std::size_t>(task),
                           [&](float value, bool) { extent.include(value); });
        found[task] = extent;
    });
    Extent all;
    for (const Extent& extent : found) {
        all.include(extent.low);
        all.include(extent.high);
    }
    // Without leaves the extent of none was included.
    if (found.empty()) all = {};
    values.visitTiles([&](float value, bool, double) { all.include(value); });
    return all;
}

}  // namespace

ValueHistogram valueHistogram(const openvdb::FloatGrid& grid, Progress& progress) {
    const BoxedValues values(grid);
    const ProgressStage stage(progress, "count", 0);
    const Extent extent = extentOf(values, progress);
    ValueHistogram histogram;
    histogram.low = extent.low;
    histogram.high = extent.high;
    const double range = histogram.high - histogram.low;
    const double scale = range > 0 ? ValueHistogram::kBins / range : 0;
    const auto binOf = [&](float value) {
        const double at = (value - histogram.low) * scale;
        return static_cast<std::size_t>(std::clamp(at, 0.0, ValueHistogram::kBins - 1.0));
    };

    // Whole numbers add up to the same in any order.
    std::vector<ValueHistogram> found(values.tasks());
    parallelFor(static_cast<std::int64_t>(found.size()), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        ValueHistogram& own = found[task];
        values.visitLeaves(static_cast<std::size_t>(task), [&](float value, bool isActive) {
            ++(isActive ? own.active : own.inactive)[binOf(value)];
        });
    });
    for (const ValueHistogram& own : found) {
        for (int bin = 0; bin < ValueHistogram::kBins; ++bin) {
            histogram.active[bin] += own.active[bin];
            histogram.inactive[bin] += own.inactive[bin];
        }
    }
    values.visitTiles([&](float value, bool isActive, double voxels) {
        (isActive ? histogram.active : histogram.inactive)[binOf(value)] += voxels;
    });
    return histogram;
}

}  // namespace bandvox

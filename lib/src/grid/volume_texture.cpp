#include "grid/summary_values.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kLeafSide = static_cast<int>(Leaf::DIM);
constexpr int kLowestSize = 4;
constexpr int kHighestSize = 1024;
// A sample beyond either end of the box.
constexpr int kMargin = 1;
// Samples along x that a task fills; few, so that there are tasks enough.
constexpr int kSlab = 4;

// The sum of 1 - |j - c|/r over whole j from a to b, within the tent.
double tentSum(double centre, double radius, double a, double b) {
    // One side of the tent: j from `from` to `to`, at distances that grow or fall by one.
    const auto side = [&](double from, double to) {
        if (from > to) return 0.0;
        const double count = to - from + 1;
        const double middle = 0.5 * (from + to);
        return count * (1 - std::abs(middle - centre) / radius);
    };
    const double top = std::floor(centre);
    return side(std::max(a, std::ceil(centre - radius)), std::min(b, top)) +
           side(std::max(a, top + 1), std::min(b, std::floor(centre + radius)));
}

// One axis of the lattice of samples.
struct SampleAxis {
    int size = 0;
    double first = 0, spacing = 1;

    double place(int sample) const { return first + sample * spacing; }

    /// The samples that voxels from a to b matter to, [begin, end).
    int begin(double a) const {
        return static_cast<int>(
            std::clamp(std::floor((a - first) / spacing - 1) + 1, 0.0, double(size)));
    }
    int end(double b) const {
        return static_cast<int>(
            std::clamp(std::ceil((b - first) / spacing + 1), 0.0, double(size)));
    }

    /// The part that voxels from a to b have in a sample.
    double weight(int sample, double a, double b) const {
        constexpr double kFar = 1e18;
        const double centre = place(sample);
        return tentSum(centre, spacing, a, b) / tentSum(centre, spacing, -kFar, kFar);
    }
};

SampleAxis placeSamples(double min, double max, double spacing) {
    SampleAxis axis;
    axis.spacing = spacing;
    const double voxels = max - min + 1;
    // A rounding error must not add a sample.
    axis.size = static_cast<int>(std::ceil(voxels / spacing - 1e-9)) + 2 * kMargin;
    axis.first = 0.5 * (min + max) - 0.5 * (axis.size - 1) * spacing;
    // Whole samples are the voxels, whatever was rounded.
    if (spacing == 1) axis.first = min - kMargin;
    return axis;
}

using Axes = std::array<SampleAxis, 3>;

Axes placeAxes(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box, int longest) {
    const openvdb::Vec3d voxel = grid.voxelSize();
    double side = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double voxels = double(box.max()[axis]) - box.min()[axis] + 1;
        side = std::max(side, voxels * voxel[axis]);
    }
    const double spacing = side / (longest - 2 * kMargin);
    Axes axes;
    for (int axis = 0; axis < 3; ++axis) {
        axes[axis] =
            placeSamples(box.min()[axis], box.max()[axis], std::max(1.0, spacing / voxel[axis]));
    }
    return axes;
}

// The parts that the voxels of a leaf have in the samples of one axis.
struct LeafWeights {
    int begin = 0, end = 0;
    std::vector<float> parts;  // [sample - begin][voxel]

    void set(const SampleAxis& axis, int origin, int least, int most) {
        begin = std::max(axis.begin(origin), least);
        end = std::min(axis.end(origin + kLeafSide - 1), most);
        parts.clear();
        for (int sample = begin; sample < end; ++sample) {
            for (int voxel = 0; voxel < kLeafSide; ++voxel) {
                const int at = origin + voxel;
                parts.push_back(static_cast<float>(axis.weight(sample, at, at)));
            }
        }
    }
    int count() const { return std::max(0, end - begin); }
};

// All voxels of equal value that no leaf holds.
struct Tile {
    openvdb::CoordBBox box;
    float rise;  // above the background
};

struct Source {
    float background;
    std::vector<const Leaf*> leaves;
    std::vector<Tile> tiles;
};

// Adds what differs from the background to the samples of one slab.
class SlabFiller {
  public:
    SlabFiller(const Axes& axes, const Source& source, VolumeTexture& texture, int begin, int end)
        : mAxes(axes), mSource(source), mTexture(texture), mBegin(begin), mEnd(end) {}

    void addLeaf(const Leaf& leaf) {
        const openvdb::Coord& origin = leaf.origin();
        mX.set(mAxes[0], origin.x(), mBegin, mEnd);
        mY.set(mAxes[1], origin.y(), 0, mAxes[1].size);
        mZ.set(mAxes[2], origin.z(), 0, mAxes[2].size);
        if (mX.count() == 0 || mY.count() == 0 || mZ.count() == 0) return;
        sumAlongZ(leaf);
        sumAlongY();
        sumAlongX();
    }

    void addTile(const Tile& tile) {
        const openvdb::Coord &min = tile.box.min(), &max = tile.box.max();
        const int xBegin = std::max(mBegin, mAxes[0].begin(min.x()));
        const int xEnd = std::min(mEnd, mAxes[0].end(max.x()));
        if (xBegin >= xEnd) return;
        const int yBegin = mAxes[1].begin(min.y()), yEnd = mAxes[1].end(max.y());
        const int zBegin = mAxes[2].begin(min.z()), zEnd = mAxes[2].end(max.z());
        mParts.clear();
        for (int x = xBegin; x < xEnd; ++x) {
            mParts.push_back(tile.rise * mAxes[0].weight(x, min.x(), max.x()));
        }
        for (int z = zBegin; z < zEnd; ++z) {
            const double zPart = mAxes[2].weight(z, min.z(), max.z());
            for (int y = yBegin; y < yEnd; ++y) {
                const double part = zPart * mAxes[1].weight(y, min.y(), max.y());
                float* row = sample(xBegin, y, z);
                for (int x = xBegin; x < xEnd; ++x) {
                    row[x - xBegin] += static_cast<float>(part * mParts[x - xBegin]);
                }
            }
        }
    }

  private:
    float* sample(int x, int y, int z) {
        const auto& size = mTexture.size;
        return &mTexture.values[(static_cast<std::size_t>(z) * size[1] + y) * size[0] + x];
    }

    // mAlongZ[x][y][sample]
    void sumAlongZ(const Leaf& leaf) {
        const float* values = leaf.buffer().data();
        const int count = mZ.count();
        mAlongZ.assign(static_cast<std::size_t>(kLeafSide) * kLeafSide * count, 0.0F);
        for (int row = 0; row < kLeafSide * kLeafSide; ++row) {
            float rises[kLeafSide];
            for (int z = 0; z < kLeafSide; ++z) {
                rises[z] =
                    finiteOr(values[row * kLeafSide + z], mSource.background) - mSource.background;
            }
            for (int s = 0; s < count; ++s) {
                float sum = 0;
                for (int z = 0; z < kLeafSide; ++z) sum += mZ.parts[s * kLeafSide + z] * rises[z];
                mAlongZ[row * count + s] = sum;
            }
        }
    }

    // mAlongY[x][y sample][z sample]
    void sumAlongY() {
        const int zs = mZ.count(), ys = mY.count();
        mAlongY.assign(static_cast<std::size_t>(kLeafSide) * ys * zs, 0.0F);
        for (int x = 0; x < kLeafSide; ++x) {
            for (int s = 0; s < ys; ++s) {
                float* out = &mAlongY[(x * ys + s) * zs];
                for (int y = 0; y < kLeafSide; ++y) {
                    const float part = mY.parts[s * kLeafSide + y];
                    if (part == 0) continue;
                    const float* in = &mAlongZ[(x * kLeafSide + y) * zs];
                    for (int z = 0; z < zs; ++z) out[z] += part * in[z];
                }
            }
        }
    }

    void sumAlongX() {
        const int zs = mZ.count(), ys = mY.count();
        for (int s = 0; s < mX.count(); ++s) {
            for (int y = 0; y < ys; ++y) {
                for (int z = 0; z < zs; ++z) {
                    float sum = 0;
                    for (int x = 0; x < kLeafSide; ++x) {
                        sum += mX.parts[s * kLeafSide + x] * mAlongY[(x * ys + y) * zs + z];
                    }
                    *sample(mX.begin + s, mY.begin + y, mZ.begin + z) += sum;
                }
            }
        }
    }

    const Axes& mAxes;
    const Source& mSource;
    VolumeTexture& mTexture;
    int mBegin, mEnd;
    LeafWeights mX, mY, mZ;
    std::vector<float> mAlongZ, mAlongY;
    std::vector<double> mParts;
};

// The tiles that differ from the background; counts those that are not finite.
std::vector<Tile> tilesOf(const openvdb::FloatGrid& grid, float background,
                          std::int64_t& notFinite) {
    std::vector<Tile> tiles;
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const float value = *tile;
        if (!std::isfinite(value)) {
            ++notFinite;
        } else if (value != background) {
            tiles.push_back({tile.getBoundingBox(), value - background});
        }
    }
    return tiles;
}

void countNotFinite(const Source& source, VolumeTexture& texture, const Progress& progress) {
    constexpr std::size_t kLeavesPerCount = 1024;
    const std::size_t tasks = (source.leaves.size() + kLeavesPerCount - 1) / kLeavesPerCount;
    std::vector<std::int64_t> counts(tasks, 0);
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerCount;
        const std::size_t end = std::min(begin + kLeavesPerCount, source.leaves.size());
        for (std::size_t i = begin; i < end; ++i) {
            const float* values = source.leaves[i]->buffer().data();
            counts[task] += std::count_if(values, values + Leaf::SIZE,
                                          [](float value) { return !std::isfinite(value); });
        }
    });
    texture.notFiniteValues += std::accumulate(counts.begin(), counts.end(), std::int64_t(0));
}

}  // namespace

VolumeTexture gridToTexture(const openvdb::FloatGrid& grid, int longest, Progress& progress) {
    if (longest < kLowestSize || longest > kHighestSize) {
        throw Error(ErrorKind::Usage,
                    "a texture of " + std::to_string(longest) + " samples a side; expected from " +
                        std::to_string(kLowestSize) + " to " + std::to_string(kHighestSize));
    }
    const openvdb::CoordBBox box = requireActiveBox(grid);
    const Axes axes = placeAxes(grid, box, longest);

    VolumeTexture texture;
    std::size_t samples = 1;
    for (int axis = 0; axis < 3; ++axis) {
        texture.size[axis] = axes[axis].size;
        texture.first[axis] = axes[axis].first;
        texture.spacing[axis] = axes[axis].spacing;
        samples *= static_cast<std::size_t>(axes[axis].size);
    }
    requireMemory(static_cast<double>(samples) * sizeof(float), "a texture of the grid");

    Source source{finiteBackground(grid), {}, {}};
    grid.tree().getNodes(source.leaves);
    source.tiles = tilesOf(grid, source.background, texture.notFiniteValues);
    countNotFinite(source, texture, progress);
    // Sort the leaves by x, so that a slab finds its own; those of one x stay in the tree's order.
    std::stable_sort(source.leaves.begin(), source.leaves.end(), [](const Leaf* a, const Leaf* b) {
        return a->origin().x() < b->origin().x();
    });

    // Fill slabs of samples apart from each other, each in the order of leaves and tiles.
    texture.values.assign(samples, source.background);
    const int slabs = (axes[0].size + kSlab - 1) / kSlab;
    const ProgressStage stage(progress, "reduce", slabs);
    parallelFor(slabs, [&](std::int64_t slab) {
        constexpr std::size_t kLeavesPerLook = 1024;
        const int begin = static_cast<int>(slab) * kSlab;
        const int end = std::min(begin + kSlab, axes[0].size);
        SlabFiller filler(axes, source, texture, begin, end);
        const double from = axes[0].place(begin) - axes[0].spacing - kLeafSide;
        const double to = axes[0].place(end - 1) + axes[0].spacing;
        auto leaf = std::partition_point(source.leaves.begin(), source.leaves.end(),
                                         [&](const Leaf* l) { return l->origin().x() < from; });
        for (std::size_t i = 0; leaf != source.leaves.end() && (*leaf)->origin().x() <= to;
             ++leaf, ++i) {
            if (i % kLeavesPerLook == 0) progress.throwIfInterrupted();
            filler.addLeaf(**leaf);
        }
        for (const Tile& tile : source.tiles) filler.addTile(tile);
        progress.advance();
    });
    const auto [low, high] = std::minmax_element(texture.values.begin(), texture.values.end());
    texture.low = *low;
    texture.high = *high;
    return texture;
}

}  // namespace bandvox

#include "core/words.h"
#include "grid/array_lattice.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_to_solid_grid.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bandvox {

namespace {

using SolidLeaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSolidSlab = SolidLeaf::DIM;

// Beyond the slices of a slab one on either side is looked at.
constexpr int kSlicesHeld = kSolidSlab + 2;

// Slices of an array, as far inside as their values are.
class HeldSlices {
  public:
    HeldSlices(const ArrayInfo& info, float outside)
        : mInfo(info), mOutside(outside), mPerSlice(std::size_t(info.valuesPerSlice())) {
        mValues.resize(kSlicesHeld * mPerSlice, outside);
    }

    /// The first slice of the slab, which lies behind the one before it.
    int first() const { return mFirst; }

    /// Goes on to the next slab, which needs so many slices more behind what is held.
    std::span<float> advance(int slices) {
        mFirst += kSolidSlab;
        std::copy(mValues.end() - std::ptrdiff_t(2 * mPerSlice), mValues.end(), mValues.begin());
        return behind(2, slices);
    }

    /// Before the first slab there is nothing.
    std::span<float> begin(int slices) { return behind(1, slices); }

    /// The row at (middle, slice) of the file's axes; null beyond the array.
    const float* row(int middle, int slice) const {
        const bool isWithin = middle >= 0 && middle < mInfo.size[mInfo.axes[1]] && slice >= 0 &&
                              slice < mInfo.slices();
        if (!isWithin) return nullptr;
        const auto held = static_cast<std::size_t>(slice) + 1 - static_cast<std::size_t>(mFirst);
        return &mValues[held * mPerSlice +
                        static_cast<std::size_t>(middle) * mInfo.size[mInfo.axes[0]]];
    }

    int rowLength() const { return mInfo.size[mInfo.axes[0]]; }
    float outside() const { return mOutside; }

  private:
    std::span<float> behind(std::size_t held, int slices) {
        const std::size_t begin = held * mPerSlice;
        const std::size_t end = begin + static_cast<std::size_t>(slices) * mPerSlice;
        std::fill(mValues.begin() + std::ptrdiff_t(end), mValues.end(), mOutside);
        return {&mValues[begin], end - begin};
    }

    const ArrayInfo& mInfo;
    float mOutside;
    std::size_t mPerSlice;
    int mFirst = 0;
    std::vector<float> mValues;
};

// What becomes of 8³ voxels.
struct SolidBlock {
    std::unique_ptr<SolidLeaf> leaf;
    openvdb::Coord origin;
    bool isInside = false;  // all of it
};

// The lowest and the highest of a block and of what lies around it.
struct ValueRange {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();

    void add(const float* values, int count) {
        for (int i = 0; i < count; ++i) {
            low = std::min(low, values[i]);
            high = std::max(high, values[i]);
        }
    }
    bool crosses() const { return low <= 0 && high > 0; }
};

ValueRange rangeAround(const HeldSlices& slices, int fast, int middle) {
    const int begin = std::max(fast - 1, 0);
    const int end = std::min(fast + kSolidSlab + 1, slices.rowLength());
    const float outside = slices.outside();
    ValueRange range;
    if (fast == 0 || end < fast + kSolidSlab + 1) range.add(&outside, 1);
    for (int s = -1; s <= kSolidSlab; ++s) {
        for (int m = -1; m <= kSolidSlab; ++m) {
            const float* row = slices.row(middle + m, slices.first() + s);
            if (row) {
                range.add(row + begin, end - begin);
            } else {
                range.add(&outside, 1);
            }
            if (range.crosses()) return range;
        }
    }
    return range;
}

std::unique_ptr<SolidLeaf> makeSolidLeaf(const HeldSlices& slices, const ArrayInfo& info, int fast,
                                         int middle, const openvdb::Coord& origin) {
    auto leaf = std::make_unique<SolidLeaf>(origin, slices.outside());
    float* to = leaf->buffer().data();
    SolidLeaf::NodeMaskType active;
    // Offsets are x, y, z, three bits each.
    const int shifts[] = {6, 3, 0};
    const int count = std::min(kSolidSlab, slices.rowLength() - fast);
    for (int s = 0; s < kSolidSlab; ++s) {
        for (int m = 0; m < kSolidSlab; ++m) {
            const float* row = slices.row(middle + m, slices.first() + s);
            if (!row) continue;
            for (int f = 0; f < count; ++f) {
                const int offset = s << shifts[info.axes[2]] | m << shifts[info.axes[1]] |
                                   f << shifts[info.axes[0]];
                to[offset] = row[fast + f];
                active.setOn(offset);
            }
        }
    }
    leaf->setValueMask(active);
    return leaf;
}

SolidBlock makeSolidBlock(const HeldSlices& slices, const ArrayInfo& info, int fast, int middle) {
    SolidBlock block;
    block.origin[info.axes[0]] = fast;
    block.origin[info.axes[1]] = middle;
    block.origin[info.axes[2]] = slices.first();
    const ValueRange range = rangeAround(slices, fast, middle);
    if (range.crosses()) {
        block.leaf = makeSolidLeaf(slices, info, fast, middle, block.origin);
    } else {
        block.isInside = range.low > 0;
    }
    return block;
}

// Turns values into how far inside they are.
void toDepths(std::span<float> values, const ArraySolidOptions& options, const ArrayInfo& info) {
    constexpr std::size_t kTogether = 1 << 16;
    const auto tasks = static_cast<std::int64_t>((values.size() + kTogether - 1) / kTogether);
    parallelFor(tasks, [&](std::int64_t task) {
        const std::size_t begin = static_cast<std::size_t>(task) * kTogether;
        const auto part = values.subspan(begin, std::min(kTogether, values.size() - begin));
        bool isFinite = true;
        for (float& value : part) {
            isFinite = isFinite && std::isfinite(value);
            value = static_cast<float>(std::min(value - options.low, options.high - value));
        }
        if (!isFinite) {
            throw Error(ErrorKind::Input,
                        info.name + ": there is a value that is not finite; expected numbers");
        }
    });
}

std::string rangeOf(const ArraySolidOptions& options) {
    if (std::isinf(options.high)) return "above " + inFull(options.low);
    return "between " + inFull(options.low) + " and " + inFull(options.high);
}

void requireValid(const ArraySolidOptions& options) {
    if (!(options.low < options.high) || !std::isfinite(options.low)) {
        throw Error(ErrorKind::Usage, "inside are values from " + inFull(options.low) + " to " +
                                          inFull(options.high) +
                                          "; expected the first to be the lower one");
    }
    if (!std::isfinite(options.outside) ||
        (options.outside > options.low && options.outside < options.high)) {
        throw Error(ErrorKind::Usage, "outside of the array are values of " +
                                          inFull(options.outside) + ", which are " +
                                          rangeOf(options) +
                                          " and so inside of the solid; "
                                          "expected a value that is not");
    }
}

}  // namespace

openvdb::FloatGrid::Ptr arrayToSolidGrid(ArraySource& source, const ArraySolidOptions& options,
                                         Progress& progress) {
    requireValid(options);
    const ArrayInfo& info = source.info();
    const openvdb::math::Transform::Ptr lattice = latticeOf(info);
    const double sliceBytes = double(info.valuesPerSlice()) * sizeof(float);
    requireMemory(kSlicesHeld * sliceBytes, "ten slices of the array");

    const double depth = std::min(options.outside - options.low, options.high - options.outside);
    HeldSlices slices(info, static_cast<float>(depth));
    auto grid = openvdb::FloatGrid::create(slices.outside());
    const float inside = std::max(-slices.outside(), std::numeric_limits<float>::min());
    const int across = (slices.rowLength() + kSolidSlab - 1) / kSolidSlab;
    const int down = (info.size[info.axes[1]] + kSolidSlab - 1) / kSolidSlab;
    std::vector<SolidBlock> blocks(static_cast<std::size_t>(across) * down);
    const ProgressStage stage(progress, "reading", (info.slices() + kSolidSlab - 1) / kSolidSlab);
    int read = 0;
    for (int first = 0; first < info.slices(); first += kSolidSlab) {
        progress.throwIfInterrupted();
        // A slab may become as large as itself.
        requireMemory(kSolidSlab * sliceBytes, "the grid, as far as it has been read,");
        const int more = std::min(first + kSolidSlab + 1, info.slices()) - read;
        const std::span<float> values = first == 0 ? slices.begin(more) : slices.advance(more);
        if (!values.empty()) source.readSlices(values);
        toDepths(values, options, info);
        read += more;
        parallelFor(down, [&](std::int64_t row) {
            for (int column = 0; column < across; ++column) {
                blocks[static_cast<std::size_t>(row) * across + column] = makeSolidBlock(
                    slices, info, column * kSolidSlab, static_cast<int>(row) * kSolidSlab);
            }
        });
        for (SolidBlock& block : blocks) {
            if (block.isInside) grid->tree().addTile(1, block.origin, inside, true);
            if (block.leaf) grid->tree().addLeaf(block.leaf.release());
        }
        progress.advance();
    }
    if (grid->empty()) {
        throw Error(ErrorKind::Result, info.name + ": no value is between " + inFull(options.low) +
                                           " and " + inFull(options.high));
    }
    openvdb::tools::pruneTiles(grid->tree(), 0.0F, /*threaded=*/false);
    grid->setTransform(lattice);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    setSourceMetadata(*grid, std::filesystem::path(info.name).filename().string());
    setPlaceMetadata(*grid, {info.unit, info.space});
    return grid;
}

}  // namespace bandvox

#include "grid/voxel_slices.h"

#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_box.h>

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace bandvox {

namespace {

using VoxelLeaf = openvdb::FloatTree::LeafNodeType;
constexpr int kVoxelLeafSide = VoxelLeaf::DIM;

// How far beyond a range values may be without being called clipped, as part of the range: as much
// as densities of the standard filter are beyond 0 and 1.
constexpr double kRangeSlack = 1e-3;

bool isWholeType(VoxelType type) {
    return type == VoxelType::UInt8 || type == VoxelType::UInt16 || type == VoxelType::Int16;
}

// What happens to values on their way.
struct Encoding {
    double low = 0, factor = 1;     // stored = (value - low) · factor
    double least = 0, largest = 0;  // of what can be stored
    double slack = 0;               // beyond these without being clipped
    bool rounds = false;
};

Encoding encodingOf(const VoxelsToWrite& voxels) {
    Encoding encoding;
    switch (voxels.type) {
        case VoxelType::UInt8:
            encoding.largest = std::numeric_limits<std::uint8_t>::max();
            break;
        case VoxelType::UInt16:
            encoding.largest = std::numeric_limits<std::uint16_t>::max();
            break;
        case VoxelType::Int16:
            encoding.largest = std::numeric_limits<std::int16_t>::max();
            encoding.least = std::numeric_limits<std::int16_t>::min();
            break;
        case VoxelType::Half:
            encoding.largest = HALF_MAX;
            encoding.least = -HALF_MAX;
            break;
        default:
            encoding.largest = std::numeric_limits<double>::infinity();
            encoding.least = -encoding.largest;
    }
    encoding.rounds = isWholeType(voxels.type);
    encoding.slack = encoding.rounds ? 0.5 : 0;
    if (!voxels.range) return encoding;
    const auto [low, high] = *voxels.range;
    if (!encoding.rounds) {
        throw Error(ErrorKind::Usage,
                    "a range of values is for types of whole numbers, and the type is " +
                        voxelTypeNames()[static_cast<std::size_t>(voxels.type)]);
    }
    if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) {
        throw Error(ErrorKind::Usage, "the range of values is " + inShort(low) + " to " +
                                          inShort(high) + "; expected two, the lower one first");
    }
    encoding.low = low;
    encoding.factor = encoding.largest / (high - low);
    encoding.least = 0;
    encoding.slack = std::max(0.5, kRangeSlack * encoding.largest);
    return encoding;
}

struct RowCounts {
    float minimum = std::numeric_limits<float>::infinity();
    float maximum = -std::numeric_limits<float>::infinity();
    std::int64_t clipped = 0, rounded = 0;
};

template <typename Stored>
void encodeRow(const Encoding& encoding, std::span<const float> values, char* to,
               RowCounts& counts) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        counts.minimum = std::min(counts.minimum, values[i]);
        counts.maximum = std::max(counts.maximum, values[i]);
        double value = (double(values[i]) - encoding.low) * encoding.factor;
        const bool isKept = !encoding.rounds && std::isnan(value);
        if (!isKept && (!(value >= encoding.least - encoding.slack) ||
                        !(value <= encoding.largest + encoding.slack))) {
            ++counts.clipped;
        }
        // What is no number becomes the least whole one.
        if (!isKept) {
            value = value >= encoding.least ? std::min(value, encoding.largest) : encoding.least;
        }
        if (encoding.rounds) {
            const double whole = std::nearbyint(value);
            if (whole != value) ++counts.rounded;
            value = whole;
        }
        Stored stored;
        if constexpr (std::is_same_v<Stored, Imath::half>) {
            stored = Imath::half(static_cast<float>(value));
        } else {
            stored = static_cast<Stored>(value);
        }
        std::memcpy(to + i * sizeof(Stored), &stored, sizeof(Stored));
    }
}

void encodeRow(VoxelType type, const Encoding& encoding, std::span<const float> values, char* to,
               RowCounts& counts) {
    switch (type) {
        case VoxelType::UInt8:
            return encodeRow<std::uint8_t>(encoding, values, to, counts);
        case VoxelType::UInt16:
            return encodeRow<std::uint16_t>(encoding, values, to, counts);
        case VoxelType::Int16:
            return encodeRow<std::int16_t>(encoding, values, to, counts);
        case VoxelType::Half:
            return encodeRow<Imath::half>(encoding, values, to, counts);
        case VoxelType::Float:
            return encodeRow<float>(encoding, values, to, counts);
        case VoxelType::Double:
            return encodeRow<double>(encoding, values, to, counts);
    }
}

// Slices from `at` on until the next multiple of a leaf's side, at most `left`.
int untilNextLeaf(int at, int left) {
    return std::min(kVoxelLeafSide - (at & (kVoxelLeafSide - 1)), left);
}

}  // namespace

const std::vector<std::string>& voxelTypeNames() {
    static const std::vector<std::string> names{"uint8", "uint16", "int16",
                                                "half",  "float",  "double"};
    return names;
}

std::size_t bytesOf(VoxelType type) {
    constexpr std::array<std::size_t, 6> kBytes{1, 2, 2, 2, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

VoxelSlices::VoxelSlices(const openvdb::FloatGrid& grid, const VoxelsToWrite& voxels,
                         std::array<int, 3> axes)
    : mGrid(grid), mVoxels(voxels), mAxes(axes) {
    encodingOf(voxels);  // throws
    mResult.box = voxels.box ? *voxels.box : arrayBox(grid);
    if (mResult.box.empty()) {
        throw Error(voxels.box ? ErrorKind::Usage : ErrorKind::Result,
                    voxels.box ? "the box of voxels is empty; expected its first corner to be no "
                                 "further along any axis than its last"
                               : "the grid '" + grid.getName() +
                                     "' has no active voxels, so no box of voxels to write");
    }
    constexpr double kLongest = 1 << 20;
    const openvdb::CoordBBox& all = mResult.box;
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = double(all.max()[axis]) - all.min()[axis] + 1;
        if (length > kLongest) {
            throw Error(ErrorKind::Usage, "the box of voxels is " + inShort(length) +
                                              " long; expected up to 2^20 along each axis");
        }
        count *= length;
    }
    mResult.count = static_cast<std::int64_t>(count);
    mResult.minimum = std::numeric_limits<double>::infinity();
    mResult.maximum = -mResult.minimum;
    requireMemory(count / slices() * kVoxelLeafSide * double(sizeof(float) + bytesOf(mVoxels.type)),
                  "eight slices of the array");
}

std::size_t VoxelSlices::bytesPerSlice() const {
    return static_cast<std::size_t>(size()[mAxes[0]]) * size()[mAxes[1]] * bytesOf(mVoxels.type);
}

int VoxelSlices::together() const {
    return untilNextLeaf(box().min()[mAxes[2]] + mNext, slices() - mNext);
}

const std::vector<char>& VoxelSlices::next() {
    const int count = together();
    fill(count);
    encode(count);
    mNext += count;
    return mBytes;
}

void VoxelSlices::fill(int slices) {
    const openvdb::Coord length = size();
    const std::size_t rowPitch = length[mAxes[0]];
    const std::size_t slicePitch = rowPitch * length[mAxes[1]];
    mValues.resize(slicePitch * slices);
    // One row of leaves after another.
    const openvdb::Coord low = box().min(), high = box().max();
    const int firstRow = low[mAxes[1]] & ~(kVoxelLeafSide - 1);
    const int rows = (high[mAxes[1]] - firstRow) / kVoxelLeafSide + 1;
    parallelFor(rows, [&](std::int64_t row) {
        const openvdb::FloatGrid::ConstAccessor from = mGrid.getConstAccessor();
        openvdb::CoordBBox part;
        part.min()[mAxes[2]] = low[mAxes[2]] + mNext;
        part.max()[mAxes[2]] = low[mAxes[2]] + mNext + slices - 1;
        const int first = firstRow + static_cast<int>(row) * kVoxelLeafSide;
        part.min()[mAxes[1]] = std::max(first, low[mAxes[1]]);
        part.max()[mAxes[1]] = std::min(first + kVoxelLeafSide - 1, high[mAxes[1]]);
        for (int begin = low[mAxes[0]]; begin <= high[mAxes[0]];) {
            const int count = untilNextLeaf(begin, high[mAxes[0]] - begin + 1);
            part.min()[mAxes[0]] = begin;
            part.max()[mAxes[0]] = begin + count - 1;
            const VoxelLeaf* leaf = from.probeConstLeaf(part.min());
            const float tile = leaf ? 0 : from.getValue(part.min());
            openvdb::Coord at;
            for (at[mAxes[2]] = part.min()[mAxes[2]]; at[mAxes[2]] <= part.max()[mAxes[2]];
                 ++at[mAxes[2]]) {
                for (at[mAxes[1]] = part.min()[mAxes[1]]; at[mAxes[1]] <= part.max()[mAxes[1]];
                     ++at[mAxes[1]]) {
                    float* to = &mValues[(at[mAxes[2]] - part.min()[mAxes[2]]) * slicePitch +
                                         (at[mAxes[1]] - low[mAxes[1]]) * rowPitch +
                                         (begin - low[mAxes[0]])];
                    for (int i = 0; i < count; ++i) {
                        at[mAxes[0]] = begin + i;
                        to[i] = leaf ? leaf->getValue(at) : tile;
                    }
                }
            }
            begin += count;
        }
    });
}

void VoxelSlices::encode(int slices) {
    const Encoding encoding = encodingOf(mVoxels);
    const std::size_t rowLength = size()[mAxes[0]];
    const std::int64_t rows = std::int64_t(size()[mAxes[1]]) * slices;
    mBytes.resize(bytesPerSlice() * slices);
    std::vector<RowCounts> counts(rows);
    // Rows are short, and a task each would be many.
    constexpr std::int64_t kRowsTogether = 64;
    parallelFor((rows + kRowsTogether - 1) / kRowsTogether, [&](std::int64_t task) {
        const std::int64_t end = std::min((task + 1) * kRowsTogether, rows);
        for (std::int64_t row = task * kRowsTogether; row < end; ++row) {
            const std::size_t begin = static_cast<std::size_t>(row) * rowLength;
            encodeRow(mVoxels.type, encoding, {&mValues[begin], rowLength},
                      &mBytes[begin * bytesOf(mVoxels.type)], counts[row]);
        }
    });
    for (const RowCounts& row : counts) {
        mResult.minimum = std::min<double>(mResult.minimum, row.minimum);
        mResult.maximum = std::max<double>(mResult.maximum, row.maximum);
        mResult.clipped += row.clipped;
        if (!mVoxels.range) mResult.rounded += row.rounded;
    }
}

}  // namespace bandvox

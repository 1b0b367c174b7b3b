#include "grid/guarded_reads.h"

#include "core/instruction_sets.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

// The order of the reads that is followed here is that of readTopology and readBuffers of
// OpenVDB's nodes, and of readCompressedValues in openvdb/io/Compression.h.

namespace bandvox {
namespace {

constexpr std::string_view kTableType = "__delayedload";
constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kLeafMaskBytes = 64;         // 8³ voxels
constexpr std::size_t kLowerMaskBytes = 512;       // 16³ children
constexpr std::size_t kUpperMaskBytes = 4096;      // 32³ children
constexpr std::size_t kBloscHeaderBytes = 16;      // at the head of what Blosc compressed;
constexpr std::size_t kBloscCompressedBytes = 12;  // in it, the place of the length, 32 bits

template <typename T>
T numberIn(std::span<const char> bytes, std::size_t offset = 0) {
    T number{};
    std::memcpy(&number, bytes.data() + offset, sizeof(T));
    return number;
}

// Of a mask, whose bytes are whole words.
BANDVOX_FOR_EACH_INSTRUCTION_SET
std::uint64_t countBits(const char* bytes, std::size_t size) {
    int bits = 0;
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes + i, sizeof word);
        bits += std::popcount(word);
    }
    return static_cast<std::uint64_t>(bits);
}

// Size of a value stored in half precision, or 0 for a type that is stored as it is.
std::uint64_t halfBytes(const std::string& type) {
    struct Entry {
        const char* type;
        std::uint64_t bytes;
    };
    static constexpr std::array kReals{Entry{"float", 2}, Entry{"double", 2}, Entry{"vec2s", 4},
                                       Entry{"vec2d", 4}, Entry{"vec3s", 6},  Entry{"vec3d", 6}};
    for (const Entry& entry : kReals) {
        if (type == entry.type) return entry.bytes;
    }
    return 0;
}

}  // namespace

void ReadGuard::beginGrid(const openvdb::GridBase& grid) {
    // What is left from the grid before would be taken for the background of this one.
    openvdb::io::setGridBackgroundValuePtr(*mStream, nullptr);
    mTree = nullptr;
    mHalf = grid.saveFloatAsHalf();
    mHalfBytes = halfBytes(grid.valueType());
    mHoldsPoints = grid.valueType() == "ptdataidx32";
}

void ReadGuard::endGrid() {
    openvdb::io::setGridBackgroundValuePtr(*mStream, nullptr);
    mTree = nullptr;
}

void ReadGuard::moveTo(std::streamoff place) {
    const std::streamoff over = place - mPlace;
    mPlace = place;
    if (over > 0 && (mStage == Stage::Blosc || mStage == Stage::Values)) endChunk();
}

ReadGuard ReadGuard::forLeaves(std::ios_base& stream, std::streamoff size) const {
    ReadGuard guard = *this;
    guard.mStream = &stream;
    guard.mSize = size;
    guard.mPlace = 0;
    guard.mLast = guard.mBeforeLast = {};
    guard.mStage = Stage::Between;
    return guard;
}

bool ReadGuard::lastNumberIsTooLarge() const {
    return mLast.number > static_cast<std::uint64_t>(left());
}

bool ReadGuard::follow(std::span<const char> bytes) {
    if (bytes.empty()) return true;
    mPlace += static_cast<std::streamoff>(bytes.size());
    const bool sound = isSound(bytes);
    mBeforeLast = mLast;
    mLast = {bytes.data(), bytes.size(), 0};
    if (bytes.size() == 4) mLast.number = numberIn<std::uint32_t>(bytes);
    if (bytes.size() == 8) mLast.number = numberIn<std::uint64_t>(bytes);
    return sound;
}

bool ReadGuard::isSound(std::span<const char> bytes) {
    if (mStream == nullptr) return true;
    const void* background = openvdb::io::getGridBackgroundValuePtr(*mStream);
    if (background != nullptr) {
        if (background != mTree) enterTree(background);
        return isSoundInTree(bytes);
    }
    return isSoundOutsideOfTrees(bytes);
}

bool ReadGuard::isSoundOutsideOfTrees(std::span<const char> bytes) {
    // Behind the name of its type a table has its length, its number of entries, the length of its
    // first part, that part, and the length of the second, where all ones say that there is none.
    constexpr int kSecondPart = 5;
    if (mTableReads >= 0) ++mTableReads;
    if (std::string_view(bytes.data(), bytes.size()) == kTableType) mTableReads = 0;
    const bool mayBeOnes = mTableReads == kSecondPart;
    if (mayBeOnes) mTableReads = -1;

    // 4 bytes are the length of what follows, or a number of things that take a byte at least,
    // except after 4 (the length of metadata, which they are then) and after 1 (the number of
    // buffers, and they are the background). Right behind the kind of compression these are the
    // number of metadata, and the length of a name follows; or a name of 4 bytes stands there
    // behind a number, which has no bytes of 0 or 255.
    constexpr std::uint32_t kKinds = 256;
    if (bytes.size() != 4) return true;
    const auto number = numberIn<std::uint32_t>(bytes);
    const bool isName =
        std::none_of(bytes.begin(), bytes.end(), [](char c) { return c == '\0' || c == '\xff'; });
    const bool isCount = mBeforeLast.size == 4 && mBeforeLast.number < kKinds && !isName;
    const bool isValue = mLast.size == 4 && (mLast.number == 4 || mLast.number == 1) && !isCount;
    const bool isOnes = number == std::numeric_limits<std::uint32_t>::max();
    return isValue || (isOnes && mayBeOnes) || number <= left();
}

void ReadGuard::enterTree(const void* background) {
    // OpenVDB tells of the background when it has read it, and that read tells of its size.
    mTree = background;
    mValueBytes = mLast.to == background ? mLast.size : 0;
    mNodesAreComplete = false;
    mStage = Stage::Between;
    mMaskBytes = 0;
}

bool ReadGuard::isMask(std::size_t size) const {
    // The voxels of points are compressed in a way of their own, with lengths of 16 bits.
    return (size == kLeafMaskBytes && !mHoldsPoints) || size == kLowerMaskBytes ||
           size == kUpperMaskBytes;
}

bool ReadGuard::isOldFormat() const {
    return openvdb::io::getFormatVersion(*mStream) <
           openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
}

bool ReadGuard::isSoundInTree(std::span<const char> bytes) {
    if (mNodesAreComplete) return true;
    switch (mStage) {
        case Stage::Between:
        case Stage::Mask:
            // Beside nodes a byte says whether a tile of the root is active, or the value of one
            // that is true or false.
            if (mStage == Stage::Between && bytes.size() == 1 && !isOldFormat() &&
                static_cast<unsigned char>(bytes[0]) > 1) {
                return false;
            }
            if (isMask(bytes.size())) {
                followMask(bytes);
            } else if (mStage == Stage::Mask) {
                if (isOldFormat() && bytes.size() == kLengthBytes) return isSoundLength(bytes);
                followBesideMask(bytes);
            } else if (mHoldsPoints && bytes.size() == 2) {
                // The number of passes over the leaves, which hold nothing that is followed.
                mNodesAreComplete = true;
            }
            return true;
        case Stage::Extras:
            if (--mExtras == 0) expectChunk(mValues);
            return true;
        case Stage::Length:
            return isSoundLength(bytes);
        case Stage::Blosc:
            endChunk();
            return numberIn<std::uint32_t>(bytes, kBloscCompressedBytes) == bytes.size();
        case Stage::Values:
            endChunk();
            return true;
    }
    return true;
}

void ReadGuard::followMask(std::span<const char> bytes) {
    // Nodes that can have children have a mask of these, and then one of the active values.
    const bool second = mStage == Stage::Mask && mMaskBytes == bytes.size();
    mChildren = second ? mActive : 0;
    mActive = countBits(bytes.data(), bytes.size());
    mMaskBytes = bytes.size();
    mStage = Stage::Mask;
    if (!isOldFormat()) return;
    const std::uint64_t voxels = 8 * std::uint64_t(mMaskBytes);
    const bool leaf = mMaskBytes == kLeafMaskBytes;
    mChunkBytes =
        (leaf ? voxels : voxels - mChildren) * (mHalf && mHalfBytes > 0 ? mHalfBytes : mValueBytes);
}

void ReadGuard::followBesideMask(std::span<const char> bytes) {
    // In the old format a leaf's origin and the number of its buffers.
    if (isOldFormat()) return;
    if (bytes.size() != 1) {
        mStage = Stage::Between;
        return;
    }
    using namespace openvdb::io;
    const unsigned kind = static_cast<unsigned char>(bytes[0]);
    const bool activeOnly =
        (getDataCompression(*mStream) & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS;
    mValues = activeOnly ? mActive : 8 * std::uint64_t(mMaskBytes);
    switch (kind) {
        case NO_MASK_AND_ONE_INACTIVE_VAL:
        case MASK_AND_NO_INACTIVE_VALS:
            mExtras = 1;
            break;
        case MASK_AND_ONE_INACTIVE_VAL:
            mExtras = 2;
            break;
        case MASK_AND_TWO_INACTIVE_VALS:
            mExtras = 3;
            break;
        default:
            mExtras = 0;
    }
    mStage = Stage::Extras;
    if (mExtras == 0) expectChunk(mValues);
}

void ReadGuard::expectChunk(std::uint64_t values) {
    const bool half = mHalf && mHalfBytes > 0;
    mChunkBytes = values * (half ? mHalfBytes : mValueBytes);
    const bool compressed = (openvdb::io::getDataCompression(*mStream) &
                             (openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ZIP)) != 0;
    // No value in half precision makes no chunk, nor does none that is not compressed.
    if (values == 0 && (half || !compressed)) {
        endChunk();
    } else {
        mStage = compressed ? Stage::Length : Stage::Values;
    }
}

bool ReadGuard::isSoundLength(std::span<const char> bytes) {
    if (bytes.size() != kLengthBytes) {
        mStage = Stage::Between;
        return true;
    }
    const auto length = numberIn<std::int64_t>(bytes);
    const bool blosc =
        (openvdb::io::getDataCompression(*mStream) & openvdb::io::COMPRESS_BLOSC) != 0;
    if (length > 0) {
        mStage = blosc ? Stage::Blosc : Stage::Values;
        return length <= left() && (!blosc || std::uint64_t(length) >= kBloscHeaderBytes);
    }
    // The chunk is not compressed.
    if (length == 0) {
        endChunk();
    } else {
        mStage = Stage::Values;
    }
    return 0 - static_cast<std::uint64_t>(length) == mChunkBytes;
}

void ReadGuard::endChunk() {
    // In the old format further buffers of a leaf may follow.
    mStage = isOldFormat() ? Stage::Mask : Stage::Between;
}

}  // namespace bandvox

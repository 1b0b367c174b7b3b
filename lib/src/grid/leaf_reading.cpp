#include "grid/leaf_reading.h"

#include <bandvox/core/parallel.h>

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cstdint>
#include <istream>
#include <memory>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

constexpr std::size_t kLeavesPerTask = 128;

// Moves a stream over a leaf, of which it reads the lengths alone.
template <typename Value>
void skipLeaf(std::istream& stream, bool half) {
    using namespace openvdb::io;
    const std::uint32_t compression = getDataCompression(stream);
    openvdb::util::NodeMask<3> active;
    active.load(stream);
    std::int8_t kind = 0;
    stream.read(reinterpret_cast<char*>(&kind), 1);

    // What stands for the inactive voxels.
    Value inactive;
    const auto skipValue = [&] {
        stream.read(reinterpret_cast<char*>(&inactive), sizeof inactive);
    };
    if (kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL ||
        kind == MASK_AND_TWO_INACTIVE_VALS) {
        skipValue();
    }
    if (kind == MASK_AND_TWO_INACTIVE_VALS) skipValue();
    if (kind == MASK_AND_NO_INACTIVE_VALS || kind == MASK_AND_ONE_INACTIVE_VAL ||
        kind == MASK_AND_TWO_INACTIVE_VALS) {
        openvdb::util::NodeMask<3>().load(stream);
    }

    // The voxels.
    const bool activeOnly =
        (compression & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS;
    const std::int64_t values = activeOnly ? active.countOn() : active.SIZE;
    if (half && values == 0) return;
    const auto bytes =
        static_cast<std::int64_t>(half ? sizeof(typename RealToHalf<Value>::HalfT) : sizeof(Value));
    std::int64_t length = values * bytes;
    if ((compression & (COMPRESS_BLOSC | COMPRESS_ZIP)) != 0) {
        std::int64_t stored = 0;
        stream.read(reinterpret_cast<char*>(&stored), sizeof stored);
        // Of a chunk that is not compressed the length is negative, and has been looked at.
        if (stored > 0) length = stored;
    }
    stream.seekg(length, std::ios::cur);
}

// A grid that finds out where in the file its leaves are, and has tasks read those it has found.
// OpenVDB's own reads them one after another.
template <typename Tree>
class QuickGrid final : public openvdb::Grid<Tree> {
  public:
    explicit QuickGrid(GuardedBuffer& buffer) : mBuffer(buffer) {}

    using openvdb::Grid<Tree>::readBuffers;
    void readBuffers(std::istream& stream) override {
        // Leaves of older files say more than their voxels.
        if (openvdb::io::getFormatVersion(stream) <
            openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION) {
            openvdb::Grid<Tree>::readBuffers(stream);
            return;
        }
        const bool half = this->saveFloatAsHalf();
        std::vector<Leaf*> leaves;
        this->tree().getNodes(leaves);
        const std::size_t tasks = (leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask;
        std::vector<std::streamoff> places(tasks + 1);  // where tasks begin, and the end
        places[0] = stream.tellg();
        const auto find = [&](std::int64_t task) {
            const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
            const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
            for (std::size_t i = begin; i < end; ++i) {
                skipLeaf<typename Tree::ValueType>(stream, half);
            }
            places[task + 1] = stream.tellg();
        };

        // What tasks begin with, while this thread goes on over the leaves.
        const openvdb::io::StreamMetadata metadata = *openvdb::io::getStreamMetadataPtr(stream);
        const std::ios::iostate exceptions = stream.exceptions();
        const GuardedBuffer before(mBuffer, 0, 0, stream);
        parallelAsMade(static_cast<std::int64_t>(tasks), find, [&](std::int64_t task) {
            std::istream part(nullptr);
            GuardedBuffer buffer(before, places[task], places[task + 1], part);
            part.rdbuf(&buffer);
            part.exceptions(exceptions);
            auto copy = std::make_shared<openvdb::io::StreamMetadata>(metadata);
            openvdb::io::setStreamMetadataPtr(part, copy, /*transfer=*/true);
            const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
            const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
            for (std::size_t i = begin; i < end; ++i) leaves[i]->readBuffers(part, half);
        });
    }

  private:
    using Leaf = typename Tree::LeafNodeType;

    GuardedBuffer& mBuffer;
};

// Reads by a QuickGrid, if the grid is of this type.
template <typename Tree>
bool readQuickly(const openvdb::GridBase::Ptr& grid, GuardedBuffer& buffer,
                 const std::function<void(const openvdb::GridBase::Ptr&)>& read) {
    if (!grid->isType<openvdb::Grid<Tree>>()) return false;
    const auto quick = std::make_shared<QuickGrid<Tree>>(buffer);
    quick->setSaveFloatAsHalf(grid->saveFloatAsHalf());
    read(quick);
    grid->setTree(quick->baseTreePtr());
    grid->setTransform(quick->transformPtr());
    static_cast<openvdb::MetaMap&>(*grid) = static_cast<const openvdb::MetaMap&>(*quick);
    return true;
}

}  // namespace

void readByAllThreads(const openvdb::GridBase::Ptr& grid, GuardedBuffer& buffer,
                      const std::function<void(const openvdb::GridBase::Ptr&)>& read) {
    if (readQuickly<openvdb::FloatTree>(grid, buffer, read) ||
        readQuickly<openvdb::DoubleTree>(grid, buffer, read) ||
        readQuickly<openvdb::Vec3STree>(grid, buffer, read)) {
        return;
    }
    read(grid);
}

}  // namespace bandvox

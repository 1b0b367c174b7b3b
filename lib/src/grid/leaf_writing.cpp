#include "grid/leaf_writing.h"

#include "grid/spooled_grid.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ios>
#include <memory>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

constexpr std::size_t kLeavesTogether = 32;
/// Of such groups in memory at once, before they go to the file.
constexpr std::size_t kGroupsTogether = 64;

// Memory to which leaves are written as to a stream, in which it is told how.
class PartOutput {
  public:
    explicit PartOutput(std::ios_base& told)
        : mMetadata(std::make_shared<openvdb::io::StreamMetadata>()) {
        mStream.exceptions(std::ios::badbit | std::ios::failbit);
        if (const auto metadata = openvdb::io::getStreamMetadataPtr(told)) *mMetadata = *metadata;
        openvdb::io::setStreamMetadataPtr(mStream, mMetadata, /*transfer=*/false);
        openvdb::io::setVersion(mStream,
                                openvdb::VersionId(openvdb::OPENVDB_LIBRARY_MAJOR_VERSION,
                                                   openvdb::OPENVDB_LIBRARY_MINOR_VERSION),
                                openvdb::OPENVDB_FILE_VERSION);
        openvdb::io::setDataCompression(mStream, openvdb::io::getDataCompression(told));
        openvdb::io::setGridBackgroundValuePtr(mStream,
                                               openvdb::io::getGridBackgroundValuePtr(told));
    }
    PartOutput(const PartOutput&) = delete;
    PartOutput& operator=(const PartOutput&) = delete;

    std::ostringstream& stream() { return mStream; }

  private:
    openvdb::io::StreamMetadata::Ptr mMetadata;  // the stream has its address
    std::ostringstream mStream;
};

// Puts the active values of a leaf behind each other. Returns how many there are; none if an
// inactive one is not the background.
std::optional<openvdb::Index> gatherActive(const openvdb::FloatTree::LeafNodeType& leaf,
                                           float background, float* active) {
    using Word = openvdb::Index64;
    constexpr openvdb::Index kBits = 8 * sizeof(Word);
    const float* values = leaf.buffer().data();
    openvdb::Index count = 0;
    bool isOther = false;
    for (openvdb::Index n = 0; n < leaf.SIZE / kBits; ++n, values += kBits) {
        const Word word = leaf.getValueMask().getWord<Word>(n);
        if (word == ~Word(0)) {
            std::copy_n(values, kBits, active + count);
            count += kBits;
            continue;
        }
        // Each is put down, and the next over it if it was not active.
        for (openvdb::Index bit = 0; bit < kBits; ++bit) {
            const bool isActive = (word >> bit & 1) != 0;
            active[count] = values[bit];
            count += isActive ? 1 : 0;
            isOther |= !isActive && values[bit] != background;
        }
    }
    return isOther ? std::nullopt : std::optional(count);
}

// A grid whose leaves are compressed by tasks, and then written in their order. OpenVDB's own
// compresses one after another.
template <typename Tree>
class QuickWrittenGrid final : public openvdb::Grid<Tree> {
  public:
    explicit QuickWrittenGrid(typename Tree::Ptr tree) : openvdb::Grid<Tree>(std::move(tree)) {}

    using openvdb::Grid<Tree>::writeBuffers;
    void writeBuffers(std::ostream& stream) const override {
        std::vector<const typename Tree::LeafNodeType*> leaves;
        this->tree().getNodes(leaves);
        const bool half = this->saveFloatAsHalf();
        writeByAllThreads(stream, leaves.size(), [&](std::size_t i, std::ostream& part) {
            if constexpr (std::is_same_v<Tree, openvdb::FloatTree>) {
                writeLeaf(*leaves[i], part, half);
            } else {
                leaves[i]->writeBuffers(part, half);
            }
        });
    }
};

template <typename Tree>
openvdb::GridBase::Ptr writtenQuickly(const openvdb::GridBase& grid) {
    if (!grid.isType<openvdb::Grid<Tree>>()) return nullptr;
    const auto tree = openvdb::StaticPtrCast<Tree>(
        openvdb::ConstPtrCast<openvdb::TreeBase>(grid.constBaseTreePtr()));
    const auto quick = std::make_shared<QuickWrittenGrid<Tree>>(tree);
    static_cast<openvdb::MetaMap&>(*quick) = static_cast<const openvdb::MetaMap&>(grid);
    quick->setTransform(grid.transform().copy());
    return quick;
}

}  // namespace

void writeLeaf(const openvdb::FloatTree::LeafNodeType& leaf, std::ostream& stream, bool half) {
    const std::uint32_t compression = openvdb::io::getDataCompression(stream);
    const auto* background =
        static_cast<const float*>(openvdb::io::getGridBackgroundValuePtr(stream));
    std::array<float, openvdb::FloatTree::LeafNodeType::SIZE> active;
    std::optional<openvdb::Index> count;
    if (!half && background && (compression & openvdb::io::COMPRESS_ACTIVE_MASK) != 0) {
        count = gatherActive(leaf, *background, active.data());
    }
    if (!count) return leaf.writeBuffers(stream, half);
    leaf.getValueMask().save(stream);
    stream.put(openvdb::io::NO_MASK_OR_INACTIVE_VALS);
    openvdb::io::writeData(stream, active.data(), *count, compression);
}

void writeByAllThreads(std::ostream& stream, std::size_t count,
                       const std::function<void(std::size_t, std::ostream&)>& writeLeaf) {
    PartOutput told(stream);
    std::size_t begun = 0;
    const auto begin = [&](tbb::flow_control& flow) {
        const std::size_t first = begun;
        if (first >= count) flow.stop();
        begun += kLeavesTogether;
        return first;
    };
    const auto compress = [&](std::size_t first) {
        PartOutput part(told.stream());
        const std::size_t end = std::min(first + kLeavesTogether, count);
        for (std::size_t leaf = first; leaf < end; ++leaf) writeLeaf(leaf, part.stream());
        return std::move(part.stream()).str();
    };
    const auto write = [&](const std::string& bytes) {
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    };
    tbb::parallel_pipeline(
        kGroupsTogether,
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin) &
            tbb::make_filter<std::size_t, std::string>(tbb::filter_mode::parallel, compress) &
            tbb::make_filter<std::string, void>(tbb::filter_mode::serial_in_order, write));
}

openvdb::GridBase::Ptr writtenByAllThreads(const openvdb::GridBase& grid) {
    if (dynamic_cast<const SpooledGrid*>(&grid) != nullptr) {
        return openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid());
    }
    if (auto quick = writtenQuickly<openvdb::FloatTree>(grid)) return quick;
    if (auto quick = writtenQuickly<openvdb::DoubleTree>(grid)) return quick;
    if (auto quick = writtenQuickly<openvdb::Vec3STree>(grid)) return quick;
    return openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid());
}

}  // namespace bandvox

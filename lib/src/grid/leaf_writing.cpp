#include "grid/leaf_writing.h"

#include "grid/spooled_grid.h"

#include <bandvox/core/parallel.h>

#include <openvdb/io/io.h>

#include <algorithm>
#include <cstdint>
#include <ios>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

constexpr std::size_t kLeavesTogether = 32;
/// Of such groups in memory at once, before they go to the file.
constexpr std::size_t kGroupsTogether = 64;

// How leaves are to be compressed is told in the stream.
void tellTheSame(std::ostream& part, std::ios_base& told) {
    part.exceptions(std::ios::badbit | std::ios::failbit);
    const auto metadata = openvdb::io::getStreamMetadataPtr(told);
    auto copy = std::make_shared<openvdb::io::StreamMetadata>();
    if (metadata) *copy = *metadata;
    openvdb::io::setStreamMetadataPtr(part, copy, /*transfer=*/false);
    openvdb::io::setVersion(part,
                            openvdb::VersionId(openvdb::OPENVDB_LIBRARY_MAJOR_VERSION,
                                               openvdb::OPENVDB_LIBRARY_MINOR_VERSION),
                            openvdb::OPENVDB_FILE_VERSION);
    openvdb::io::setDataCompression(part, openvdb::io::getDataCompression(told));
    openvdb::io::setGridBackgroundValuePtr(part, openvdb::io::getGridBackgroundValuePtr(told));
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
        writeByAllThreads(stream, leaves.size(), [&](std::size_t i, std::ostream& part) {
            leaves[i]->writeBuffers(part, this->saveFloatAsHalf());
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

void writeByAllThreads(std::ostream& stream, std::size_t count,
                       const std::function<void(std::size_t, std::ostream&)>& writeLeaf) {
    constexpr std::size_t kLeavesAtOnce = kLeavesTogether * kGroupsTogether;
    for (std::size_t begin = 0; begin < count; begin += kLeavesAtOnce) {
        const std::size_t end = std::min(begin + kLeavesAtOnce, count);
        std::vector<std::string> groups((end - begin + kLeavesTogether - 1) / kLeavesTogether);
        parallelFor(static_cast<std::int64_t>(groups.size()), [&](std::int64_t i) {
            const auto group = static_cast<std::size_t>(i);
            const std::size_t first = begin + group * kLeavesTogether;
            std::ostringstream part;
            tellTheSame(part, stream);
            for (std::size_t leaf = first; leaf < std::min(first + kLeavesTogether, end); ++leaf) {
                writeLeaf(leaf, part);
            }
            groups[group] = std::move(part).str();
        });
        for (const std::string& bytes : groups) {
            stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        }
    }
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

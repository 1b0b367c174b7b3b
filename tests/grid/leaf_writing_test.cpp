#include "grid/leaf_writing.h"

#include <gtest/gtest.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>

namespace bandvox {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr float kBackground = 0.25F;

// What is written to a stream of this compression.
std::string written(std::uint32_t compression, const std::function<void(std::ostream&)>& write) {
    std::ostringstream stream;
    auto metadata = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);
    openvdb::io::setDataCompression(stream, compression);
    openvdb::io::setGridBackgroundValuePtr(stream, &kBackground);
    write(stream);
    return stream.str();
}

void expectSameAsOpenVdb(const Leaf& leaf) {
    using namespace openvdb::io;
    for (const std::uint32_t compression :
         {std::uint32_t(COMPRESS_NONE), std::uint32_t(COMPRESS_ACTIVE_MASK),
          std::uint32_t(COMPRESS_ZIP | COMPRESS_ACTIVE_MASK),
          std::uint32_t(COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK)}) {
        for (const bool half : {false, true}) {
            const auto theirs = [&](std::ostream& stream) { leaf.writeBuffers(stream, half); };
            const auto ours = [&](std::ostream& stream) { writeLeaf(leaf, stream, half); };
            EXPECT_EQ(written(compression, ours), written(compression, theirs))
                << compression << " " << half;
        }
    }
}

// A leaf of random values, active where `isActive`, else of `inactive`.
Leaf makeLeaf(const std::function<bool(openvdb::Index)>& isActive,
              const std::function<float(openvdb::Index)>& inactive) {
    Leaf leaf(openvdb::Coord(8, -16, 24), kBackground, false);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        if (isActive(i)) {
            leaf.setValueOn(i, uniform(random));
        } else {
            leaf.setValueOnly(i, inactive(i));
        }
    }
    return leaf;
}

const auto kAll = [](openvdb::Index) { return true; };
const auto kNone = [](openvdb::Index) { return false; };
// Whole words of the mask, and parts of them.
const auto kSome = [](openvdb::Index i) { return i < 128 || i % 7 == 3 || i == Leaf::SIZE - 1; };
const auto kIsBackground = [](openvdb::Index) { return kBackground; };

TEST(LeafWriting, IsOpenVdbsWhereTheInactiveAreTheBackground) {
    expectSameAsOpenVdb(makeLeaf(kAll, kIsBackground));
    expectSameAsOpenVdb(makeLeaf(kNone, kIsBackground));
    expectSameAsOpenVdb(makeLeaf(kSome, kIsBackground));
}

TEST(LeafWriting, IsOpenVdbsWhereTheInactiveAreOthers) {
    for (const auto& isActive :
         {std::function<bool(openvdb::Index)>(kSome), std::function<bool(openvdb::Index)>(kNone)}) {
        expectSameAsOpenVdb(makeLeaf(isActive, [](openvdb::Index) { return -kBackground; }));
        expectSameAsOpenVdb(makeLeaf(isActive, [](openvdb::Index) { return 7.0F; }));
        expectSameAsOpenVdb(
            makeLeaf(isActive, [](openvdb::Index i) { return i == 300 ? 7.0F : kBackground; }));
        expectSameAsOpenVdb(makeLeaf(isActive, [](openvdb::Index i) { return float(i); }));
        expectSameAsOpenVdb(makeLeaf(
            isActive, [](openvdb::Index) { return std::numeric_limits<float>::quiet_NaN(); }));
    }
}

}  // namespace
}  // namespace bandvox

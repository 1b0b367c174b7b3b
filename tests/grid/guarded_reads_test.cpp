// What OpenVDB would read of a damaged file to where there is no room for it.

#include "grid/guarded_reads.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::GridBase;

constexpr std::uint32_t kCompressions[] = {
    openvdb::io::COMPRESS_NONE,
    openvdb::io::COMPRESS_ZIP,
    openvdb::io::COMPRESS_BLOSC,
    openvdb::io::COMPRESS_ACTIVE_MASK,
    openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
    openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK};

struct MetadataType {
    const char* name;
    openvdb::Metadata::Ptr (*make)();
};

// Both lock within OpenVDB and unlock here, of which tests/tsan.supp knows by this name.
void initializeOpenVdb(const MetadataType& another = {}) {
    openvdb::initialize();
    if (another.name) openvdb::Metadata::registerType(another.name, another.make);
}

std::string bytesOf(const openvdb::GridCPtrVec& grids, std::uint32_t compression) {
    std::ostringstream out;
    openvdb::io::Stream stream(out);
    stream.setCompression(compression);
    stream.write(grids);
    return out.str();
}

openvdb::GridPtrVec gridsIn(const std::string& bytes) {
    std::istringstream in(bytes);
    return readVdb(in, "test.vdb");
}

/// The message of the error that reading gives, or "" if it gives none.
std::string messageOf(const std::string& bytes) {
    try {
        gridsIn(bytes);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        return error.what();
    }
    return "";
}

/// Voxels of a few random values on and off in some leaves, with as many different inactive ones
/// as asked for (OpenVDB stores up to two of them apart), and tiles.
template <typename GridT>
typename GridT::Ptr randomGrid(unsigned inactive, typename GridT::ValueType (*value)(unsigned)) {
    std::mt19937 random(7);
    auto grid = GridT::create(value(1));
    for (int i = 0; i < 600; ++i) {
        const Coord at(random() % 12, random() % 10, random() % 9);
        grid->tree().setValueOn(at, value(random() % 5000));
        const Coord other(random() % 12, random() % 10, random() % 9);
        if (inactive > 0) grid->tree().setValueOff(other, value(random() % inactive));
    }
    for (int i = 1; i < 4; ++i) grid->tree().addTile(1, Coord(64 * i, 0, 0), value(i), i % 2 == 0);
    grid->tree().addTile(3, Coord(8192, 0, 0), value(9), true);
    return grid;
}

template <typename GridT>
void expectRoundTrip(typename GridT::ValueType (*value)(unsigned), bool half = false) {
    for (const unsigned inactive : {0U, 1U, 2U, 3U, 4U}) {
        for (const std::uint32_t compression : kCompressions) {
            SCOPED_TRACE(GridT::gridType() + ", inactive values: " + std::to_string(inactive) +
                         ", compression: " + openvdb::io::compressionToString(compression));
            const typename GridT::Ptr grid = randomGrid<GridT>(inactive, value);
            grid->setSaveFloatAsHalf(half);
            // Twice, since what is known of one grid may not be taken for the next.
            const openvdb::GridPtrVec read =
                gridsIn(bytesOf({grid, grid->deepCopy()}, compression));
            ASSERT_EQ(read.size(), 2U);
            for (const GridBase::Ptr& one : read) {
                const auto typed = openvdb::gridPtrCast<GridT>(one);
                ASSERT_TRUE(typed);
                EXPECT_TRUE(typed->tree().hasSameTopology(grid->tree()));
                auto found = typed->getConstAccessor();
                for (auto it = grid->cbeginValueOn(); it; ++it) {
                    ASSERT_EQ(found.getValue(it.getCoord()), *it) << it.getCoord();
                }
            }
        }
    }
}

TEST(GuardedReads, LetGridsOfAnyTypePass) {
    // The values are such that half precision holds them.
    expectRoundTrip<openvdb::FloatGrid>([](unsigned i) { return float(i % 512) - 0.5F; });
    expectRoundTrip<openvdb::FloatGrid>([](unsigned i) { return float(i % 512) - 0.5F; }, true);
    expectRoundTrip<openvdb::DoubleGrid>([](unsigned i) { return i * -0.001; });
    expectRoundTrip<openvdb::DoubleGrid>([](unsigned i) { return double(i % 512); }, true);
    expectRoundTrip<openvdb::Vec3SGrid>([](unsigned i) { return openvdb::Vec3s(i, 1, 2); });
    expectRoundTrip<openvdb::Vec3DGrid>([](unsigned i) { return openvdb::Vec3d(i % 99, 1, 2); },
                                        true);
    expectRoundTrip<openvdb::Vec3IGrid>([](unsigned i) { return openvdb::Vec3i(i, 1, 2); });
    expectRoundTrip<openvdb::Int32Grid>([](unsigned i) { return int(i) - 9; });
    expectRoundTrip<openvdb::Int64Grid>([](unsigned i) { return -std::int64_t(i); });
    expectRoundTrip<openvdb::Int64Grid>([](unsigned i) { return -std::int64_t(i); }, true);
    expectRoundTrip<openvdb::BoolGrid>([](unsigned i) { return i % 2 == 1; });
    expectRoundTrip<openvdb::MaskGrid>([](unsigned i) { return i != 1; });
}

TEST(GuardedReads, LetPointsPass) {
    using openvdb::Vec3R;
    namespace points = openvdb::points;
    initializeOpenVdb();  // points are made here before anything is written or read
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const auto indexOf = [&](const std::vector<Vec3R>& places) {
        return openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(
            points::PointAttributeVector<Vec3R>(places), *transform);
    };
    std::vector<Vec3R> places;
    std::mt19937 random(3);
    for (int i = 0; i < 500; ++i) places.emplace_back(random() % 40, random() % 20, i * 0.01);
    const auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(
        *indexOf(places), points::PointAttributeVector<Vec3R>(places), *transform);
    // OpenVDB 10 cannot read an index of more than one leaf.
    const auto index = indexOf({Vec3R(1, 2, 3), Vec3R(4, 5, 6)});
    for (const std::uint32_t compression : kCompressions) {
        const openvdb::GridPtrVec read = gridsIn(bytesOf({grid, grid->deepCopy()}, compression));
        ASSERT_EQ(read.size(), 2U);
        EXPECT_EQ(read[0]->activeVoxelCount(), grid->activeVoxelCount());
        EXPECT_EQ(read[1]->activeVoxelCount(), grid->activeVoxelCount());
        EXPECT_EQ(gridsIn(bytesOf({index}, compression)).at(0)->activeVoxelCount(), 2U);
    }
}

TEST(GuardedReads, LetMetadataPass) {
    const auto grid = openvdb::FloatGrid::create(3.0F);
    // Numbers that would be lengths beyond the end, and texts as long as masks.
    grid->insertMeta("a", openvdb::Int64Metadata(-4));
    grid->insertMeta("b", openvdb::Int32Metadata(-1));
    grid->insertMeta("c", openvdb::FloatMetadata(1e30F));
    grid->insertMeta("d", openvdb::StringMetadata("~~~~"));
    grid->insertMeta("e", openvdb::StringMetadata(std::string(64, '~')));
    grid->insertMeta("f", openvdb::BoolMetadata(true));
    grid->insertMeta("g", openvdb::StringMetadata(""));
    const openvdb::GridPtrVec read = gridsIn(bytesOf({grid, grid}, 0));
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[1]->metaValue<std::int32_t>("b"), -1);
    EXPECT_EQ(read[1]->metaValue<std::string>("e").size(), 64U);
}

/// A grid of one leaf, whose chunk is the last thing in the file, and the place of its length.
struct LastChunk {
    std::string bytes;
    std::size_t place = 0;
    std::int64_t length = 0;

    std::string with(std::int64_t changed, std::size_t bytesBehind) const {
        std::string all = bytes + std::string(bytesBehind, '\x55');
        std::memcpy(all.data() + place, &changed, sizeof changed);
        return all;
    }
};

LastChunk lastChunk(std::uint32_t compression, int voxels, bool half) {
    std::mt19937 random(11);
    auto grid = openvdb::FloatGrid::create(0.0F);
    for (int i = 0; i < voxels; ++i) {
        grid->tree().setValueOn(Coord(i % 8, i / 8 % 8, i / 64), 1e-9F * float(random()));
    }
    grid->setSaveFloatAsHalf(half);
    LastChunk chunk{bytesOf({grid}, compression)};
    for (std::size_t place = chunk.bytes.size() - 8; place > 0; --place) {
        std::memcpy(&chunk.length, chunk.bytes.data() + place, sizeof chunk.length);
        chunk.place = place;
        const auto behind = static_cast<std::int64_t>(chunk.bytes.size() - place - 8);
        if (std::abs(chunk.length) == behind && behind > 0) return chunk;
    }
    ADD_FAILURE() << "there is no chunk";
    return chunk;
}

TEST(GuardedReads, RefuseChunksOfAnotherLengthThanTheirVoxels) {
    constexpr std::size_t kBehind = 300000;
    using namespace openvdb::io;
    for (const std::uint32_t compression :
         {std::uint32_t(COMPRESS_ZIP), std::uint32_t(COMPRESS_BLOSC),
          std::uint32_t(COMPRESS_ZIP | COMPRESS_ACTIVE_MASK),
          std::uint32_t(COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK)}) {
        for (const bool half : {false, true}) {
            for (const int voxels : {100, 512}) {
                const LastChunk chunk = lastChunk(compression, voxels, half);
                EXPECT_EQ(messageOf(chunk.with(chunk.length, kBehind)), "");
                const std::int64_t values = (compression & COMPRESS_ACTIVE_MASK) ? voxels : 512;
                const std::int64_t raw = values * (half ? 2 : 4);
                EXPECT_EQ(messageOf(chunk.with(-raw, kBehind)), "");
                for (const std::int64_t length :
                     {-raw - 1, -raw + 1, -2 * raw, std::int64_t(-kBehind), std::int64_t(0),
                      std::int64_t(-1), std::numeric_limits<std::int64_t>::min(),
                      std::numeric_limits<std::int64_t>::max()}) {
                    const std::string message = messageOf(chunk.with(length, kBehind));
                    // Without the guard it is OpenVDB's own, when all has been overwritten.
                    EXPECT_NE(message.find("damaged"), std::string::npos)
                        << compression << ' ' << half << ' ' << voxels << ' ' << length << ": "
                        << message;
                }
            }
        }
    }
}

TEST(GuardedReads, RefuseChunksThatSayTheyAreLonger) {
    // Blosc reads as many bytes as the header of its own says.
    const LastChunk chunk = lastChunk(openvdb::io::COMPRESS_BLOSC, 100, false);
    std::string bytes = chunk.bytes + std::string(1000, '\0');
    const std::int32_t longer = static_cast<std::int32_t>(chunk.length) + 900;
    std::memcpy(bytes.data() + chunk.place + 8 + 12, &longer, sizeof longer);
    EXPECT_NE(messageOf(bytes).find("damaged"), std::string::npos) << messageOf(bytes);
    for (const std::int64_t length : {1, 4, 15}) {
        EXPECT_NE(messageOf(chunk.with(length, 100)).find("damaged"), std::string::npos) << length;
    }
}

TEST(GuardedReads, RefuseTilesThatAreNeitherActiveNorNot) {
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().root().addTile(Coord(4096, 0, 0), 0.625F, true);
    for (const std::uint32_t compression : kCompressions) {
        std::string bytes = bytesOf({grid}, compression);
        const std::size_t place = bytes.find(std::string("\0\0\x20\x3f\1", 5));
        ASSERT_NE(place, std::string::npos);
        EXPECT_EQ(messageOf(bytes), "");
        for (const char state : {'\2', '\20', '\xff'}) {
            bytes[place + 4] = state;
            EXPECT_NE(messageOf(bytes).find("damaged"), std::string::npos) << messageOf(bytes);
        }
    }
}

TEST(GuardedReads, RefuseTextThatIsLongerThanTheFile) {
    std::istream stream(nullptr);
    const auto isSound = [&stream](std::uint32_t first, std::uint32_t second) {
        ReadGuard guard(100);
        guard.watch(stream);
        EXPECT_TRUE(guard.follow({reinterpret_cast<const char*>(&first), sizeof first}));
        return guard.follow({reinterpret_cast<const char*>(&second), sizeof second});
    };
    EXPECT_TRUE(isSound(9, 92));
    EXPECT_FALSE(isSound(9, 93));
    EXPECT_TRUE(isSound(4, 93)) << "a value of 4 bytes";

    EXPECT_FALSE(isSound(9, 0xffffffff)) << "all ones";

    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->insertMeta("note", openvdb::StringMetadata("nothing"));
    std::string bytes = bytesOf({grid}, 0);
    const std::int32_t length = 0x7fffffff;
    std::memcpy(bytes.data() + bytes.find("nothing") - 4, &length, sizeof length);
    EXPECT_NE(messageOf(bytes).find("damaged"), std::string::npos);
}

TEST(GuardedReads, TellACountFromTheLengthOfAValue) {
    std::istream stream(nullptr);
    const auto isSound = [&stream](const std::vector<std::uint32_t>& numbers) {
        ReadGuard guard(100);
        guard.watch(stream);
        bool sound = true;
        for (const std::uint32_t number : numbers) {
            sound = guard.follow({reinterpret_cast<const char*>(&number), sizeof number});
        }
        return sound;
    };
    EXPECT_FALSE(isSound({6, 4, 0x7fffffff})) << "four metadata behind the kind of compression";
    EXPECT_FALSE(isSound({2, 1, 0x7fffffff})) << "one";
    EXPECT_TRUE(isSound({6, 4, 0x65746f6e})) << "a name of four letters behind a number";
    EXPECT_TRUE(isSound({0x6f6f6f66, 4, 0x7fffffff})) << "a value behind a type of four letters";
}

TEST(GuardedReads, TablesMayHaveNoSecondPart) {
    // As OpenVDB writes them: type, length, entries, the length of a part that is not compressed,
    // that part, and all ones.
    std::istream stream(nullptr);
    ReadGuard guard(1000);
    guard.watch(stream);
    const auto follow = [&guard](const std::string& bytes) {
        return guard.follow({bytes.data(), bytes.size()});
    };
    const auto number = [](std::uint32_t n) {
        return std::string(reinterpret_cast<const char*>(&n), sizeof n);
    };
    EXPECT_TRUE(follow("__delayedload"));
    EXPECT_TRUE(follow(number(40)));
    EXPECT_TRUE(follow(number(7)));
    EXPECT_TRUE(follow(number(0)));
    EXPECT_TRUE(follow("1234567"));
    EXPECT_TRUE(follow(number(0xffffffff)));
    EXPECT_FALSE(follow(number(0xffffffff))) << "the length of the next name";
}

/// Metadata that finds no memory when it is read.
class Greedy : public openvdb::StringMetadata {
  public:
    static openvdb::Metadata::Ptr make() { return std::make_shared<Greedy>(); }
    openvdb::Name typeName() const override { return "greedy"; }
    openvdb::Metadata::Ptr copy() const override { return make(); }

  protected:
    void readValue(std::istream& /*stream*/, openvdb::Index32 /*bytes*/) override {
        throw std::bad_alloc();
    }
};

TEST(GuardedReads, TellNoMemoryFromDamage) {
    initializeOpenVdb({"greedy", &Greedy::make});
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->insertMeta("note", Greedy());
    const std::string bytes = bytesOf({grid}, 0);
    EXPECT_THROW(gridsIn(bytes), std::bad_alloc);
    openvdb::Metadata::unregisterType("greedy");

    ReadGuard guard(100);
    const std::uint64_t fits = 92;
    const std::uint64_t doesNot = std::uint64_t(1) << 60;
    EXPECT_TRUE(guard.follow({reinterpret_cast<const char*>(&fits), sizeof fits}));
    EXPECT_FALSE(guard.lastNumberIsTooLarge());
    EXPECT_TRUE(guard.follow({reinterpret_cast<const char*>(&doesNot), sizeof doesNot}));
    EXPECT_TRUE(guard.lastNumberIsTooLarge());
}

TEST(GuardedReads, TellAStreamThatCannotBeRead) {
    class Failing : public std::stringbuf {
      protected:
        std::streamsize xsgetn(char* /*to*/, std::streamsize /*count*/) override {
            throw std::ios::failure("the disk is gone");
        }
        int_type underflow() override { throw std::ios::failure("the disk is gone"); }
    };
    Failing buffer;
    std::istream stream(&buffer);
    try {
        readVdb(stream, "a disk");
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(error.what()).find("a disk: it cannot be read"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace bandvox

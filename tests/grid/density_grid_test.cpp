#include "stop_after.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <string>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;

// A grid with a tile, leaves, and values that half precision cannot hold.
openvdb::FloatGrid::Ptr sampleGrid() {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->tree().addTile(1, Coord(64), 1.0F, true);
    for (int i = 0; i < 20; ++i) grid->tree().setValue(Coord(i, 2 * i, -i), 0.1F + 0.01F * i);
    return grid;
}

class DensityGridFile : public testing::Test {
  protected:
    fs::path path = fs::path(testing::TempDir()) /
                    (std::string("bandvox_grid_") +
                     testing::UnitTest::GetInstance()->current_test_info()->name() + ".vdb");
    void TearDown() override { fs::remove(path); }

    ErrorKind kindOfReadError() const {
        try {
            readVdb(path);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
            return error.kind();
        }
        ADD_FAILURE() << "nothing was thrown";
        return ErrorKind::Runtime;
    }
};

TEST(DensityMetadata, ComesBackAsItWasSet) {
    DensityMetadata metadata;
    metadata.version = "1.2.3";
    metadata.source = "bunny.obj";
    metadata.order = 4;
    metadata.cutoff = 0.2;
    metadata.iso = 0.45;
    metadata.tolerance = 1e-4;
    metadata.closureError = 2e-5;
    metadata.oversampling = 4;
    metadata.samplingError = 0.02;
    metadata.sourceVolume = 7.5;
    metadata.gridVolume = 7.4999;
    metadata.holesCapped = 5;
    metadata.clamped = true;
    const openvdb::FloatGrid::Ptr grid = sampleGrid();
    EXPECT_FALSE(densityMetadata(*grid));
    setDensityMetadata(*grid, DensityMetadata{});
    setDensityMetadata(*grid, metadata);
    const std::optional<DensityMetadata> found = densityMetadata(*grid);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->version, metadata.version);
    EXPECT_EQ(found->source, metadata.source);
    EXPECT_EQ(found->order, metadata.order);
    EXPECT_EQ(found->cutoff, metadata.cutoff);
    EXPECT_EQ(found->iso, metadata.iso);
    EXPECT_EQ(found->tolerance, metadata.tolerance);
    EXPECT_EQ(found->closureError, metadata.closureError);
    EXPECT_EQ(found->oversampling, metadata.oversampling);
    EXPECT_EQ(found->samplingError, metadata.samplingError);
    EXPECT_EQ(found->sourceVolume, metadata.sourceVolume);
    EXPECT_EQ(found->gridVolume, metadata.gridVolume);
    EXPECT_EQ(found->holesCapped, metadata.holesCapped);
    EXPECT_EQ(found->clamped, metadata.clamped);
}

TEST(DensityMetadata, BinaryVoxelsAreNoDensity) {
    const openvdb::FloatGrid::Ptr grid = sampleGrid();
    setVoxelMetadata(*grid, "bunny.obj");
    setVoxelMetadata(*grid, "cow.obj");
    EXPECT_EQ(grid->metaValue<std::string>("bandvox_source"), "cow.obj");
    EXPECT_EQ(grid->metaValue<double>("bandvox_iso"), 0.5);
    EXPECT_FALSE(densityMetadata(*grid));
}

TEST(DensityIntegral, CountsVoxelsAndTilesInWorldUnits) {
    double sum = 512;
    for (int i = 0; i < 20; ++i) sum += 0.1 + 0.01 * i;
    EXPECT_NEAR(densityIntegral(*sampleGrid()), sum * 0.125, 1e-5);
    EXPECT_EQ(densityIntegral(*openvdb::FloatGrid::create(0.0F)), 0);
}

TEST(DensityIntegral, IsNotNegativeOfAMirroredGrid) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().setValueOn(openvdb::Coord(1, 2, 3), 0.5F);
    openvdb::Mat4d mirror = openvdb::Mat4d::identity();
    mirror(0, 0) = -2;
    grid->setTransform(openvdb::math::Transform::createLinearTransform(mirror));
    EXPECT_DOUBLE_EQ(densityIntegral(*grid), 1);
}

TEST(PlaceMetadata, IsHandedOnAsFarAsItIsKnown) {
    const auto grid = openvdb::FloatGrid::create(0.0F);
    EXPECT_EQ(placeMetadata(*grid).unit, "");
    setPlaceMetadata(*grid, {"mm", ""});
    setPlaceMetadata(*grid, {"", "LPS"});
    EXPECT_EQ(placeMetadata(*grid).unit, "mm");
    EXPECT_EQ(placeMetadata(*grid).space, "LPS");
    EXPECT_TRUE((*grid)["bandvox_unit"]);
    EXPECT_TRUE((*grid)["bandvox_space"]);
}

TEST(DensityMetadata, OfFilteredValuesStandsForNoSolid) {
    const auto grid = openvdb::FloatGrid::create(0.0F);
    EXPECT_FALSE(isDensityOfSolid(*grid));
    DensityMetadata metadata;
    setDensityMetadata(*grid, metadata);
    EXPECT_TRUE(isDensityOfSolid(*grid));
    metadata.route = "filtered";
    setDensityMetadata(*grid, metadata);
    EXPECT_FALSE(isDensityOfSolid(*grid));
}

TEST_F(DensityGridFile, RoundTripKeepsEverything) {
    const openvdb::FloatGrid::Ptr grid = sampleGrid();
    setDensityMetadata(*grid, DensityMetadata{.version = "9"});
    using Compression = VdbWriteOptions::Compression;
    for (const Compression compression :
         {Compression::Blosc, Compression::Zip, Compression::None}) {
        writeVdb(path, {grid}, {.compression = compression});
        const openvdb::GridPtrVec grids = readVdb(path);
        ASSERT_EQ(grids.size(), 1U);
        const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
        ASSERT_TRUE(read);
        EXPECT_EQ(read->getName(), "density");
        EXPECT_EQ(read->getGridClass(), openvdb::GRID_FOG_VOLUME);
        EXPECT_EQ(densityMetadata(*read)->version, "9");
        EXPECT_EQ(read->transform(), grid->transform());
        EXPECT_TRUE(read->tree().hasSameTopology(grid->tree()));
        for (auto value = grid->cbeginValueOn(); value; ++value) {
            EXPECT_EQ(read->tree().getValue(value.getCoord()), *value);
        }
    }
}

TEST_F(DensityGridFile, HalfIsHalfAndLeavesTheGridAlone) {
    const openvdb::FloatGrid::Ptr grid = sampleGrid();
    writeVdb(path, {grid}, {.half = true});
    EXPECT_FALSE(grid->saveFloatAsHalf());
    const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(path).at(0));
    const Coord place(3, 6, -3);
    EXPECT_NE(read->tree().getValue(place), grid->tree().getValue(place));
    EXPECT_NEAR(read->tree().getValue(place), grid->tree().getValue(place), 1e-4);
}

TEST_F(DensityGridFile, RoundToHalfIsWhatTheFileGivesBack) {
    const openvdb::FloatGrid::Ptr grid = sampleGrid();
    writeVdb(path, {grid}, {.half = true});
    const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(path).at(0));
    const openvdb::FloatGrid::Ptr rounded = grid->deepCopy();
    const double stated = roundToHalf(*rounded);
    double largest = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const float stored = read->tree().getValue(value.getCoord());
        EXPECT_EQ(rounded->tree().getValue(value.getCoord()), stored) << value.getCoord();
        largest = std::max<double>(largest, std::abs(stored - *value));
    }
    EXPECT_GT(stated, 0);
    EXPECT_DOUBLE_EQ(stated, largest);
    EXPECT_EQ(roundToHalf(*rounded), 0);
}

TEST(DensityMetadata, IsRestatedWhenValuesAreRounded) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    const float value = 0.123456789F;
    grid->tree().setValueOn(openvdb::Coord(0), value);
    roundAndRestate(*grid);
    EXPECT_FALSE(densityMetadata(*grid)) << "it was none";
    grid->tree().setValueOn(openvdb::Coord(0), value);
    setDensityMetadata(*grid, {});
    roundAndRestate(*grid);
    const auto metadata = densityMetadata(*grid);
    const float rounded = grid->tree().getValue(openvdb::Coord(0));
    EXPECT_NE(rounded, value);
    EXPECT_DOUBLE_EQ(metadata->storageError, std::abs(double(rounded) - value));
    EXPECT_DOUBLE_EQ(metadata->gridVolume, rounded);
}

TEST_F(DensityGridFile, PlaceThatCannotBeWrittenIsAnError) {
    try {
        writeVdb("/proc/bandvox.vdb", {sampleGrid()});
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Runtime);
    }
}

TEST_F(DensityGridFile, BadFilesAreRefused) {
    fs::remove(path);
    EXPECT_EQ(kindOfReadError(), ErrorKind::Input);  // missing
    std::ofstream(path).close();
    EXPECT_EQ(kindOfReadError(), ErrorKind::Input);  // empty
    std::ofstream(path) << "this is not a volume, however long it goes on and on and on";
    EXPECT_EQ(kindOfReadError(), ErrorKind::Input);
    fs::remove(path);
    fs::create_directory(path);
    EXPECT_EQ(kindOfReadError(), ErrorKind::Input);  // a folder
}

// A file that was cut off anywhere is refused, or at least never a crash.
TEST_F(DensityGridFile, TruncatedFilesAreRefused) {
    writeVdb(path, {sampleGrid()});
    const auto size = static_cast<int>(fs::file_size(path));
    for (int cut = 1; cut < size; cut += 97) {
        writeVdb(path, {sampleGrid()});
        fs::resize_file(path, cut);
        EXPECT_EQ(kindOfReadError(), ErrorKind::Input) << cut << " of " << size;
    }
}

// What a file holds after its header, which has a name that is new each time.
std::string bytesAfterHeader(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    constexpr std::size_t kHeader = 8 + 4 + 4 + 4 + 1 + 36;
    return bytes.str().substr(kHeader);
}

// As OpenVDB writes it, one leaf after another.
std::string bytesByOpenVdb(const fs::path& path, const openvdb::GridPtrVec& grids,
                           const VdbWriteOptions& options) {
    using Compression = VdbWriteOptions::Compression;
    openvdb::GridCPtrVec saved;
    for (const openvdb::GridBase::Ptr& grid : grids) {
        const auto copy = grid->copyGrid();
        copy->setSaveFloatAsHalf(options.half);
        saved.push_back(copy);
    }
    openvdb::io::File file(path.string());
    std::uint32_t flags = openvdb::io::COMPRESS_ACTIVE_MASK;
    if (options.compression == Compression::Blosc) flags |= openvdb::io::COMPRESS_BLOSC;
    if (options.compression == Compression::Zip) flags |= openvdb::io::COMPRESS_ZIP;
    if (options.compression == Compression::None) flags = openvdb::io::COMPRESS_NONE;
    file.setCompression(flags);
    file.write(saved);
    file.close();
    return bytesAfterHeader(path);
}

// Grids with more leaves than one task reads.
template <typename GridT>
void expectManyLeavesComeBack(const fs::path& path, const VdbWriteOptions& options, int leaves) {
    std::mt19937 random(17);
    auto grid = GridT::create(typename GridT::ValueType(0));
    for (int i = 0; i < leaves; ++i) {
        const Coord origin(8 * (i % 20), 8 * (i / 20 % 15), 8 * (i / 300) - 40);
        const int voxels = i % 5 == 0 ? 512 : static_cast<int>(random() % 40);
        for (int v = 0; v < voxels; ++v) {
            const Coord at = origin + Coord(v & 7, v >> 3 & 7, v >> 6);
            grid->tree().setValue(at, typename GridT::ValueType(float(random() % 2048) / 1024));
        }
        if (voxels == 0) grid->tree().touchLeaf(origin);
    }
    grid->setName("many");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    grid->insertMeta("note", openvdb::StringMetadata("kept"));
    const auto other = grid->deepCopy();
    other->setName("second");
    // OpenVDB's notes of how long leaves are come before, and are not made.
    const std::string byOpenVdb = bytesByOpenVdb(path, {grid, other}, options);
    std::string first;
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        writeVdb(path, {grid, other}, options);
        const std::string bytes = bytesAfterHeader(path);
        ASSERT_TRUE(byOpenVdb.ends_with(bytes.substr(2 * bytes.size() / 3)));
        ASSERT_TRUE(first.empty() || bytes == first) << threads << " threads";
        first = bytes;
        openvdb::GridPtrVec read = readVdb(path);
        ASSERT_EQ(read.size(), 2U);
        for (const bool onDemand : {false, true}) {
            openvdb::io::File file(path.string());
            file.open(onDemand);
            const openvdb::GridPtrVecPtr grids = file.getGrids();
            ASSERT_EQ(grids->size(), 2U);
            read.insert(read.end(), grids->begin(), grids->end());
        }
        for (const openvdb::GridBase::Ptr& one : read) {
            const auto typed = openvdb::gridPtrCast<GridT>(one);
            ASSERT_TRUE(typed);
            EXPECT_TRUE(typed->tree().hasSameTopology(grid->tree()));
            EXPECT_EQ(typed->transform(), grid->transform());
            EXPECT_EQ(typed->template metaValue<std::string>("note"), "kept");
            auto leaf = grid->tree().cbeginLeaf();
            for (auto found = typed->tree().cbeginLeaf(); found; ++found, ++leaf) {
                ASSERT_EQ(found->origin(), leaf->origin());
                ASSERT_EQ(found->buffer(), leaf->buffer()) << leaf->origin();
            }
        }
        EXPECT_EQ(read[0]->getName(), "many");
        EXPECT_EQ(read[1]->getName(), "second");
    }
}

TEST_F(DensityGridFile, ManyLeavesComeBackWhoeverReadsThem) {
    using Compression = VdbWriteOptions::Compression;
    for (const Compression compression :
         {Compression::Blosc, Compression::Zip, Compression::None}) {
        for (const bool half : {false, true}) {
            VdbWriteOptions options;
            options.compression = compression;
            options.half = half;
            // More than are written at once; by the others, which are slow, more than a task reads.
            const int leaves = compression == Compression::Blosc ? 2400 : 300;
            SCOPED_TRACE(std::to_string(static_cast<int>(compression)) + (half ? " half" : ""));
            expectManyLeavesComeBack<openvdb::FloatGrid>(path, options, leaves);
            expectManyLeavesComeBack<openvdb::DoubleGrid>(path, options, leaves);
            expectManyLeavesComeBack<openvdb::Vec3SGrid>(path, options, leaves);
        }
    }
}

// Names that OpenVDB's reader knows grids by, and trees that several share.
TEST_F(DensityGridFile, NamesAndSharedTreesAreAsOpenVdbWritesThem) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().setValue(Coord(1, 2, 3), 0.5F);
    openvdb::GridPtrVec grids;
    for (const char* name : {"one", "", "one", "other", ""}) {
        grids.push_back(grids.size() == 3 ? grid->deepCopy() : grid->copy());
        grids.back()->setName(name);
    }
    const auto look = [&] {
        openvdb::io::File file(path.string());
        file.open();
        std::vector<std::string> found;
        for (auto name = file.beginName(); name != file.endName(); ++name) {
            found.push_back(openvdb::io::GridDescriptor::nameAsString(*name));
        }
        const openvdb::GridPtrVecPtr read = file.getGrids();
        for (const openvdb::GridBase::Ptr& one : *read) {
            const auto same = std::find_if(read->begin(), read->end(), [&](const auto& other) {
                return &other->baseTree() == &one->baseTree();
            });
            found.push_back(one->getName() + " has tree " + std::to_string(same - read->begin()));
        }
        return found;
    };
    bytesByOpenVdb(path, grids, {});
    const std::vector<std::string> expected = look();
    writeVdb(path, {grids.begin(), grids.end()});
    EXPECT_EQ(look(), expected);
    EXPECT_EQ(expected.size(), 10U);
}

TEST_F(DensityGridFile, DamageInAnyOfManyLeavesIsNoticed) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    std::mt19937 random(23);
    for (int i = 0; i < 400000; ++i) {
        grid->tree().setValue(Coord(i % 80, i / 80 % 80, i / 6400),
                              1e-6F * static_cast<float>(random() % 1000000));
    }
    writeVdb(path, {grid});
    std::string bytes(fs::file_size(path), '\0');
    std::ifstream(path, std::ios::binary)
        .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    // Chunks that Blosc made begin with a length of 8 bytes and its version.
    int damaged = 0;
    for (std::size_t i = bytes.size() / 4; i + 40 < bytes.size(); ++i) {
        std::int64_t length = 0;
        std::int32_t inside = 0;
        std::memcpy(&length, &bytes[i], sizeof length);
        std::memcpy(&inside, &bytes[i + 20], sizeof inside);
        if (length < 100 || length > 4000 || inside != length) continue;
        if (++damaged % 50 != 0) continue;
        for (const std::int64_t wrong : {length - 1, length + 1, -length, std::int64_t(1) << 40}) {
            std::string changed = bytes;
            std::memcpy(&changed[i], &wrong, sizeof wrong);
            std::ofstream(path, std::ios::binary) << changed;
            EXPECT_EQ(kindOfReadError(), ErrorKind::Input) << i << ' ' << wrong;
        }
    }
    EXPECT_GT(damaged, 500);
}

// Lengths that the middle of a file does not mean are no overruns.
TEST_F(DensityGridFile, FilesThatGoOnWithRubbishAreRefused) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    std::mt19937 random(5);
    for (int i = 0; i < 60000; ++i) {
        grid->tree().setValue(Coord(i % 40, i / 40 % 40, i / 1600),
                              1e-6F * static_cast<float>(random() % 1000000));
    }
    writeVdb(path, {grid});
    const auto size = static_cast<int>(fs::file_size(path));
    for (int cut = size / 4; cut < size - 1000; cut += size / 16) {
        writeVdb(path, {grid});
        fs::resize_file(path, cut);
        std::ofstream file(path, std::ios::binary | std::ios::app);
        for (int i = 0; i < 400000; ++i) file.put(static_cast<char>(random()));
        file.close();
        EXPECT_EQ(kindOfReadError(), ErrorKind::Input) << cut << " of " << size;
    }
}

// Of a type whose leaves this library reads and writes, and of one whose leaves OpenVDB does.
TEST_F(DensityGridFile, IsReadAndWrittenUntilTheWorkIsToStop) {
    const auto floats = openvdb::FloatGrid::create(0.0F);
    const auto wholes = openvdb::Int32Grid::create(0);
    std::mt19937 random(7);
    for (int i = 0; i < 120 * 120 * 120; ++i) {
        const Coord at(i % 120, i / 120 % 120, i / 14400);
        floats->tree().setValue(at, static_cast<float>(random() % 1000000));
        wholes->tree().setValue(at, static_cast<int>(random() % 1000000));
    }
    constexpr int kMegabytes = 6;
    const VdbWriteOptions options{.compression = VdbWriteOptions::Compression::None};
    for (const openvdb::GridBase::Ptr& grid :
         {openvdb::GridBase::Ptr(floats), openvdb::GridBase::Ptr(wholes)}) {
        SCOPED_TRACE(grid->valueType());
        fs::remove(path);
        expectStopsMidway(1000, [&](Progress& progress) {
            fs::remove(path);
            writeVdb(path, {grid}, options, progress);
        });
        EXPECT_FALSE(fs::exists(path));
        writeVdb(path, {grid}, options);
        expectStopsMidway(kMegabytes, [&](Progress& progress) { readVdb(path, progress); });
        expectStopsMidway(kMegabytes, [&](Progress& progress) {
            std::ifstream file(path, std::ios::binary);
            readVdb(file, "a stream", progress);
        });
    }
}

TEST(RoundToHalf, StopsWhenInterrupted) {
    expectStopsMidway(5, [](Progress& progress) {
        const auto grid = sampleGrid();
        roundAndRestate(*grid, progress);
        densityIntegral(*grid, progress);
    });
}

TEST_F(DensityGridFile, ComesFromAStreamThatCannotGoBack) {
    writeVdb(path, {sampleGrid()});
    std::ifstream file(path, std::ios::binary);
    const openvdb::GridPtrVec grids = readVdb(file, "a stream");
    ASSERT_EQ(grids.size(), 1U);
    EXPECT_EQ(grids[0]->activeVoxelCount(), sampleGrid()->activeVoxelCount());
    try {
        readVdb(file, "a stream");
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(error.what()).find("a stream"), std::string::npos);
    }
}

}  // namespace
}  // namespace bandvox

// Grids as arrays, and back.

#include <bandvox/core/error.h>
#include <bandvox/grid/array_box.h>
#include <bandvox/grid/array_to_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/write_array.h>
#include <bandvox/source/array_source.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

// Numbers without a pattern, some of them the background, whole ones if `whole`.
float valueAt(const Coord& at, bool whole) {
    const unsigned mixed =
        (static_cast<unsigned>(at.x()) * 73856093U ^ static_cast<unsigned>(at.y()) * 19349663U ^
         static_cast<unsigned>(at.z()) * 83492791U) %
        1000U;
    if (mixed < 300) return 0;
    return whole ? static_cast<float>(mixed % 256) : static_cast<float>(mixed) * 0.00137F - 0.4F;
}

// A box across the borders of leaves; (-20 .. -13, ...) is one tile of 7.
openvdb::FloatGrid::Ptr makeGrid(bool whole) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    auto to = grid->getAccessor();
    for (auto at = CoordBBox(-11, -3, 5, 9, 12, 30).begin(); at; ++at) {
        if (const float value = valueAt(*at, whole); value != 0) to.setValue(*at, value);
    }
    grid->tree().addTile(1, Coord(0, 0, 16), 7, true);
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    matrix.preScale(Vec3d(0.25, 0.5, 1.5));
    matrix.postRotate(openvdb::math::Z_AXIS, 0.7);
    matrix.postRotate(openvdb::math::X_AXIS, -0.3);
    matrix.postTranslate(Vec3d(10, -20, 3));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    grid->setName("density");
    return grid;
}

class WriteArray : public testing::Test {
  protected:
    void SetUp() override {
        mFolder = fs::temp_directory_path() / ("bandvox-write-" + std::to_string(getpid()));
        fs::create_directories(mFolder);
    }
    void TearDown() override { fs::remove_all(mFolder); }

    static WrittenVoxels write(const fs::path& path, ArrayFormat format,
                               const openvdb::FloatGrid& grid,
                               const ArrayWriteOptions& options = {}) {
        AtomicFile file(path);
        const WrittenVoxels written = writeArray(file, nullptr, format, grid, options);
        file.commit();
        return written;
    }

    static std::string bytesOf(const fs::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    // What a file holds is the grid's box, bit for bit, and where that is.
    static void expectGrid(const fs::path& path, const openvdb::FloatGrid& grid,
                           const CoordBBox& box, bool hasTransform = true) {
        SCOPED_TRACE(path.string());
        const auto source = openArray(path);
        ASSERT_EQ(source->info().size, box.dim());
        const auto read = arrayToGrid(*source);
        const auto found = read->getConstAccessor(), expected = grid.getConstAccessor();
        for (auto at = box.begin(); at; ++at) {
            ASSERT_EQ(found.getValue(*at - box.min()), expected.getValue(*at)) << *at;
        }
        EXPECT_EQ(arrayBox(*read), CoordBBox(Coord(0), box.dim().offsetBy(-1)));
        if (!hasTransform) return;
        for (const Vec3d& at : {Vec3d(0.0), Vec3d(7, 0, 0), Vec3d(0, 9, 0), Vec3d(0, 0, 20)}) {
            EXPECT_LT(
                (read->indexToWorld(at) - grid.indexToWorld(at + box.min().asVec3d())).length(),
                1e-9);
        }
    }

    static void expectRefused(const std::string& said, ErrorKind kind,
                              const std::function<void()>& act) {
        try {
            act();
            ADD_FAILURE() << "expected an error that says " << said;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
        }
    }

    fs::path mFolder;
};

TEST_F(WriteArray, ComesBackBitForBit) {
    const auto grid = makeGrid(false);
    const CoordBBox box = grid->evalActiveVoxelBoundingBox();
    ASSERT_EQ(box.max().z(), 30);
    ArrayWriteOptions options;
    const WrittenVoxels written = write(mFolder / "a.npy", ArrayFormat::Npy, *grid);
    EXPECT_EQ(written.box, box);
    EXPECT_EQ(written.count, static_cast<std::int64_t>(box.volume()));
    EXPECT_EQ(written.maximum, 7);
    EXPECT_EQ(written.clipped, 0);
    EXPECT_EQ(written.rounded, 0);
    expectGrid(mFolder / "a.npy", *grid, box, false);
    const WrittenVoxels examined = examineVoxels(*grid);
    EXPECT_EQ(examined.box, box);
    EXPECT_EQ(examined.minimum, written.minimum);
    EXPECT_EQ(examined.maximum, written.maximum);
    write(mFolder / "a.nrrd", ArrayFormat::Nrrd, *grid);
    expectGrid(mFolder / "a.nrrd", *grid, box);
    write(mFolder / "a.mha", ArrayFormat::MetaImage, *grid);
    expectGrid(mFolder / "a.mha", *grid, box);
    options.compress = true;
    write(mFolder / "packed.nrrd", ArrayFormat::Nrrd, *grid, options);
    expectGrid(mFolder / "packed.nrrd", *grid, box);
    write(mFolder / "packed.mha", ArrayFormat::MetaImage, *grid, options);
    expectGrid(mFolder / "packed.mha", *grid, box);
    EXPECT_LT(fs::file_size(mFolder / "packed.nrrd"), fs::file_size(mFolder / "a.nrrd"));
    options.voxels.type = VoxelType::Double;
    write(mFolder / "d.nrrd", ArrayFormat::Nrrd, *grid, options);
    expectGrid(mFolder / "d.nrrd", *grid, box);

    // What was an array once has its size again, and comes out as it was.
    const auto source = openArray(mFolder / "a.nrrd");
    const auto again = arrayToGrid(*source);
    write(mFolder / "b.nrrd", ArrayFormat::Nrrd, *again);
    EXPECT_EQ(bytesOf(mFolder / "a.nrrd"), bytesOf(mFolder / "b.nrrd"));
}

TEST_F(WriteArray, KeepsValuesBesideTheHeader) {
    const auto grid = makeGrid(true);
    for (const bool compress : {false, true}) {
        for (const auto& [name, format] :
             {std::pair("h.nhdr", ArrayFormat::Nrrd), std::pair("h.mhd", ArrayFormat::MetaImage)}) {
            AtomicFile header(mFolder / name), values(mFolder / "h.raw");
            ArrayWriteOptions options;
            options.compress = compress;
            options.voxels.type = VoxelType::UInt8;
            writeArray(header, &values, format, *grid, options);
            values.commit();
            header.commit();
            EXPECT_LT(fs::file_size(mFolder / name), 1000U);
            expectGrid(mFolder / name, *grid, grid->evalActiveVoxelBoundingBox());
        }
    }
}

TEST_F(WriteArray, HoldsWholeNumbersAndHalves) {
    const auto grid = makeGrid(true);
    for (const VoxelType type : {VoxelType::UInt8, VoxelType::UInt16, VoxelType::Int16,
                                 VoxelType::Half, VoxelType::Double}) {
        ArrayWriteOptions options;
        options.voxels.type = type;
        const WrittenVoxels written = write(mFolder / "t.npy", ArrayFormat::Npy, *grid, options);
        EXPECT_EQ(written.clipped, 0);
        EXPECT_EQ(written.rounded, 0);
        expectGrid(mFolder / "t.npy", *grid, written.box, false);
    }
    ArrayWriteOptions half;
    half.voxels.type = VoxelType::Half;
    for (const ArrayFormat format : {ArrayFormat::Nrrd, ArrayFormat::MetaImage}) {
        expectRefused("no values of type half", ErrorKind::Usage,
                      [&] { write(mFolder / "no", format, *grid, half); });
    }
}

TEST_F(WriteArray, MapsARangeAndCountsWhatIsClipped) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    const std::vector<float> values{-0.2F, -0.0005F, 0, 0.25F, 0.5F, 1, 1.0005F, 1.2F, NAN};
    for (std::size_t x = 0; x < values.size(); ++x) {
        grid->tree().setValueOn(Coord(static_cast<int>(x), 0, 0), values[x]);
    }
    ArrayWriteOptions options;
    options.voxels.type = VoxelType::UInt16;
    options.voxels.range = {0.0, 1.0};
    const auto stored = [&](const WrittenVoxels& written) {
        std::vector<float> found(static_cast<std::size_t>(written.count));
        openArray(mFolder / "r.npy")->readSlices(found);
        return found;
    };
    const WrittenVoxels dense = write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options);
    EXPECT_EQ(dense.clipped, 3) << "ringing within 0.001 is none";
    EXPECT_EQ(dense.rounded, 0) << "that is what a range asks for";
    EXPECT_EQ(stored(dense), (std::vector<float>{0, 0, 0, 16384, 32768, 65535, 65535, 65535, 0}));
    options.voxels.type = VoxelType::Int16;
    options.voxels.range = {-1.0, 1.0};
    const WrittenVoxels centred = write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options);
    EXPECT_EQ(centred.clipped, 2);
    EXPECT_EQ(stored(centred)[2], 16384) << "half of 32767, and even";
    // As they are: rounded, and counted.
    options.voxels.range.reset();
    options.voxels.type = VoxelType::UInt8;
    const WrittenVoxels plain = write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options);
    EXPECT_EQ(plain.clipped, 1) << "what is no number";
    EXPECT_EQ(plain.rounded, 4);
    EXPECT_NEAR(plain.minimum, -0.2, 1e-6);
    EXPECT_NEAR(plain.maximum, 1.2, 1e-6);
    // What is no number stays that where it can.
    options.voxels.type = VoxelType::Float;
    const WrittenVoxels same = write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options);
    EXPECT_EQ(same.clipped, 0);
    EXPECT_TRUE(std::isnan(stored(same).back()));
    options.voxels.type = VoxelType::UInt8;
    options.voxels.range = {1.0, 1.0};
    expectRefused("the lower one first", ErrorKind::Usage,
                  [&] { write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options); });
    options.voxels = {.type = VoxelType::Float, .range = {{0.0, 1.0}}};
    expectRefused("whole numbers", ErrorKind::Usage,
                  [&] { write(mFolder / "r.npy", ArrayFormat::Npy, *grid, options); });
}

TEST_F(WriteArray, KeepsTheUnitAndTheSpace) {
    const auto grid = makeGrid(false);
    setPlaceMetadata(*grid, {"mm", "left-posterior-superior"});
    write(mFolder / "p.nrrd", ArrayFormat::Nrrd, *grid);
    const auto array = openArray(mFolder / "p.nrrd");
    EXPECT_EQ(array->info().unit, "mm");
    EXPECT_EQ(array->info().space, "left-posterior-superior");
    const auto back = placeMetadata(*arrayToGrid(*array));
    EXPECT_EQ(back.unit, "mm");
    // Nothing of a unit gets out of its quotes.
    setPlaceMetadata(*grid, {"mm\"\nsizes: 1 1 1", ""});
    write(mFolder / "p.nrrd", ArrayFormat::Nrrd, *grid);
    EXPECT_EQ(openArray(mFolder / "p.nrrd")->info().unit, "");
}

// Readers of MetaImage take a scan's world for left-posterior-superior.
TEST_F(WriteArray, TurnsAScanToTheWorldOfMetaImage) {
    const auto grid = makeGrid(false);
    setPlaceMetadata(*grid, {"mm", "RAS"});
    write(mFolder / "p.mha", ArrayFormat::MetaImage, *grid);
    const auto array = openArray(mFolder / "p.mha");
    EXPECT_EQ(array->info().space, "left-posterior-superior");
    array->turnTo("RAS");
    const auto back = arrayToGrid(*array);
    const Coord first = grid->evalActiveVoxelBoundingBox().min();
    EXPECT_LT((back->indexToWorld(Coord(0)) - grid->indexToWorld(first)).length(), 1e-12);
    EXPECT_LT(
        (back->indexToWorld(Coord(3, 4, 5)) - grid->indexToWorld(first + Coord(3, 4, 5))).length(),
        1e-12);
}

TEST_F(WriteArray, TakesTheBoxThatIsAskedFor) {
    const auto grid = makeGrid(false);
    ArrayWriteOptions options;
    for (const CoordBBox& box :
         {CoordBBox(-30, -3, 5, -12, 0, 6), CoordBBox(3, 3, 3, 3, 3, 3),
          CoordBBox(-13, -9, 2, 17, 15, 33), CoordBBox(0, 0, 16, 7, 7, 23)}) {
        options.voxels.box = box;
        write(mFolder / "b.nrrd", ArrayFormat::Nrrd, *grid, options);
        expectGrid(mFolder / "b.nrrd", *grid, box);
    }
    options.voxels.box = CoordBBox(0, 0, 0, -1, 0, 0);
    expectRefused("box", ErrorKind::Usage,
                  [&] { write(mFolder / "no", ArrayFormat::Nrrd, *grid, options); });
    options.voxels.box = CoordBBox(0, 0, 0, 1 << 21, 0, 0);
    expectRefused("2^20", ErrorKind::Usage,
                  [&] { write(mFolder / "no", ArrayFormat::Nrrd, *grid, options); });
    options.voxels.box = CoordBBox(0, 0, 0, 1 << 19, 1 << 19, 0);
    expectRefused("memory", ErrorKind::Memory,
                  [&] { write(mFolder / "no", ArrayFormat::Nrrd, *grid, options); });
    expectRefused("no active voxels", ErrorKind::Result, [&] {
        write(mFolder / "no", ArrayFormat::Nrrd, *openvdb::FloatGrid::create(0.0F));
    });
    EXPECT_FALSE(fs::exists(mFolder / "no"));
}

TEST_F(WriteArray, KnowsTheBoxOfAnArray) {
    const auto grid = makeGrid(false);
    const CoordBBox active = grid->evalActiveVoxelBoundingBox();
    EXPECT_EQ(arrayBox(*grid), active);
    const CoordBBox box(-50, -50, -50, 60, 60, 60);
    setArrayBox(*grid, box);
    EXPECT_EQ(arrayBox(*grid), box);
    // Whoever has added voxels outside has not told.
    grid->tree().setValueOn(Coord(61, 0, 16), 1);
    EXPECT_EQ(arrayBox(*grid).max().x(), 61);
    EXPECT_EQ(arrayBox(*grid).min(), active.min());
    grid->tree().setValueOff(Coord(61, 0, 16));
    dropArrayBox(*grid);
    EXPECT_EQ(arrayBox(*grid), active);
}

}  // namespace
}  // namespace bandvox

#include "bandlimit/closed_form_density.h"
#include "source/test_meshes.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/bandlimit/surface_to_vdb.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

class SurfaceToVdb : public testing::Test {
  protected:
    SurfaceToVdb()
        : mFolder(fs::temp_directory_path() /
                  (std::string("bandvox-vdb-") + std::to_string(::getpid()) + "-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name())) {
        fs::create_directories(mFolder);
    }
    ~SurfaceToVdb() override { fs::remove_all(mFolder); }

    // A limit that leaves so many bytes to the work.
    static std::int64_t limitOf(std::int64_t bytes) {
        returnFreeMemory();
        return residentMemory() + bytes;
    }

    fs::path mFolder;
};

constexpr std::int64_t kMegabyte = 1 << 20;

bool isInMemory(const DensityResult& result) {
    const auto leaf = result.grid->tree().cbeginLeaf();
    return !leaf->buffer().empty();
}

void expectSame(const DensityResult& a, const DensityResult& b) {
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(a.surfaceSamples, b.surfaceSamples);
    EXPECT_EQ(a.tiles, b.tiles);
    EXPECT_EQ(a.minimum, b.minimum);
    EXPECT_EQ(a.maximum, b.maximum);
    EXPECT_EQ(a.overlaps, b.overlaps);
    EXPECT_EQ(a.refinements, b.refinements);
    for (auto entry = a.grid->beginMeta(); entry != a.grid->endMeta(); ++entry) {
        const auto other = (*b.grid)[entry->first];
        ASSERT_TRUE(other) << entry->first;
        EXPECT_EQ(other->str(), entry->second->str()) << entry->first;
    }
    EXPECT_EQ(a.grid->metaCount(), b.grid->metaCount());
}

void expectSameGrid(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    ASSERT_TRUE(a.tree().hasSameTopology(b.tree()));
    auto other = b.tree().cbeginLeaf();
    for (auto leaf = a.tree().cbeginLeaf(); leaf; ++leaf, ++other) {
        ASSERT_TRUE(leaf->buffer() == other->buffer()) << leaf->origin();
    }
    EXPECT_EQ(a.transform(), b.transform());
}

TEST_F(SurfaceToVdb, WritesWhatIsMadeWithoutALimit) {
    const ThreadLimit threads(2);
    const std::pair<const char*, int> shapes[] = {
        {"shape:torus", 256}, {"shape:cube", 180}, {"shape:two-balls", 360}};
    for (const auto& [shape, resolution] : shapes) {
        const auto source = makeShapeBoundary(shape);
        DensityOptions options;
        options.resolution = resolution;
        options.filter = {4, 0.25};
        const DensityResult whole = surfaceToDensity(*source, options);
        const VdbTarget target{mFolder / "x.vdb", {}, limitOf(48 * kMegabyte)};
        const DensityResult made = surfaceToVdb(*source, options, target);
        EXPECT_FALSE(isInMemory(made)) << shape;
        expectSame(whole, made);
        const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(target.file).front());
        expectSameGrid(*whole.grid, *read);
    }
}

TEST_F(SurfaceToVdb, LimitsShellsThatOverlap) {
    const ThreadLimit threads(2);
    Mesh balls = ballMesh(70, openvdb::Vec3d(0), 5);
    test::append(balls, ballMesh(70, openvdb::Vec3d(50, 0, 0), 5));
    const MeshSource source("balls", balls);
    DensityOptions options;
    options.voxelSize = 1 / 1.6;
    VdbTarget target{mFolder / "x.vdb", {}, limitOf(48 * kMegabyte)};
    target.write.half = true;
    const DensityResult made = surfaceToVdb(source, options, target);
    EXPECT_FALSE(isInMemory(made));
    DensityResult whole = surfaceToDensity(source, options);
    roundAndRestate(*whole.grid);
    EXPECT_TRUE(made.metadata.clamped);
    expectSame(whole, made);
    const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(target.file).front());
    expectSameGrid(*whole.grid, *read);
}

TEST_F(SurfaceToVdb, KeepsInMemoryWhatFits) {
    const auto source = makeShapeBoundary("shape:torus");
    const DensityOptions options{.resolution = 64};
    DensityResult whole = surfaceToDensity(*source, options);
    for (const std::int64_t limit : {std::int64_t(0), std::int64_t(1) << 40}) {
        for (const bool rounds : {false, true}) {
            if (rounds) roundAndRestate(*whole.grid);
            const VdbTarget target{mFolder / "x.vdb", {.half = rounds}, limit};
            const DensityResult made = surfaceToSpooledDensity(*source, options, target);
            EXPECT_TRUE(isInMemory(made));
            expectSame(whole, made);
            expectSameGrid(*whole.grid, *made.grid);
        }
        whole = surfaceToDensity(*source, options);
    }
}

TEST_F(SurfaceToVdb, SaysWhatALimitThatIsTooLowWouldHaveToBe) {
    const auto source = makeShapeBoundary("shape:torus");
    const VdbTarget target{mFolder / "x.vdb", {}, 1 << 20};
    try {
        surfaceToVdb(*source, {.resolution = 500}, target);
        FAIL() << "a megabyte was enough";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Memory);
        const std::string text = error.what();
        EXPECT_NE(text.find("more than the limit of 1 MiB"), std::string::npos) << text;
    }
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST_F(SurfaceToVdb, RefusesAPart) {
    const auto source = makeShapeBoundary("shape:torus");
    DensityOptions options;
    options.shard = {1, 3};
    EXPECT_THROW(surfaceToVdb(*source, options, {mFolder / "x.vdb", {}, 0}), Error);
    EXPECT_TRUE(fs::is_empty(mFolder));
}

}  // namespace
}  // namespace bandvox

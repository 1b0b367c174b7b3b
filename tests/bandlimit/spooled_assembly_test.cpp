#include "bandlimit/spooled_assembly.h"

#include "bandlimit/closed_form_density.h"
#include "bandlimit/density_steps.h"
#include "bandlimit/fill_columns.h"
#include "bandlimit/grid_assembly.h"
#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

class SpooledAssemblyTest : public testing::Test {
  protected:
    SpooledAssemblyTest() : mFolder(fs::temp_directory_path() / folderName()) {
        fs::create_directories(mFolder);
    }
    ~SpooledAssemblyTest() override { fs::remove_all(mFolder); }

    static std::string folderName() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        return std::string("bandvox-spool-") + std::to_string(::getpid()) + "-" + test->name();
    }

    // What a file of a grid holds, without the number that makes each file another.
    std::string bytesOf(const openvdb::GridBase::ConstPtr& grid, const VdbWriteOptions& options) {
        const fs::path path = mFolder / "grid.vdb";
        writeVdb(path, {grid}, options);
        std::ifstream stream(path, std::ios::binary);
        std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        constexpr std::size_t kBefore = 21, kNumber = 36;
        return bytes.erase(kBefore, kNumber);
    }

    fs::path mFolder;
};

/// A solid whose columns are filled, and what its grid is to be.
struct Case {
    Case(std::unique_ptr<BoundarySource> surface, const ExponentialFilter& filter, int resolution,
         int tile = 0)
        : source(std::move(surface)) {
        options.filter = filter;
        options.resolution = resolution;
        options.tile = tile;
        plan.emplace(makeTilePlan(options));
        layout = layOutTiles(source->bounds(),
                             chooseVoxelSize(source->name(), source->bounds(), options), *plan);
        tileFilter.emplace(*plan);
    }

    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    openvdb::FloatGrid::Ptr whole(bool clamp) const {
        FilledColumns columns =
            fillColumns(*source, *plan, layout, *tileFilter, "", silentProgress());
        return assembleGrid(columns.blocks, layout, {plan->threshold, clamp});
    }

    // In parts of as many columns as take so many bytes.
    std::unique_ptr<SpooledAssembly> spooled(bool clamp, bool rounds, double memory,
                                             const fs::path& target) const {
        auto assembly = std::make_unique<SpooledAssembly>(
            layout, AssemblyOptions{plan->threshold, clamp}, rounds, target);
        ColumnFiller filler(*source, *plan, layout, *tileFilter);
        int parts = 0;
        for (; !filler.isDone(); ++parts) {
            assembly->add(filler.fillNext(memory, silentProgress()).blocks);
        }
        EXPECT_GT(parts, 1);
        return assembly;
    }

    std::unique_ptr<BoundarySource> source;
    DensityOptions options;
    std::optional<TilePlan> plan;
    TileLayout layout;
    std::optional<TileFilter> tileFilter;
};

std::unique_ptr<BoundarySource> overlappingBalls() {
    Mesh balls = ballMesh(30, openvdb::Vec3d(0), 4);
    test::append(balls, ballMesh(30, openvdb::Vec3d(17, 3, 2), 4));
    test::append(balls, ballMesh(12, openvdb::Vec3d(9, 1, 1), 4));
    return std::make_unique<MeshSource>("balls", std::move(balls));
}

TEST_F(SpooledAssemblyTest, GivesTheFileOfTheWhole) {
    const ExponentialFilter soft{2, 0.16}, sharp{4, 0.25};
    std::vector<std::unique_ptr<Case>> cases;
    for (const char* shape : {"shape:sphere", "shape:torus", "shape:cube", "shape:two-balls"}) {
        cases.push_back(std::make_unique<Case>(makeShapeBoundary(shape), sharp, 96, 48));
    }
    cases.push_back(std::make_unique<Case>(makeShapeBoundary("shape:torus"), soft, 120));
    cases.push_back(std::make_unique<Case>(overlappingBalls(), sharp, 80, 40));
    for (const auto& each : cases) {
        const Case& one = *each;
        for (const bool clamp : {false, true}) {
            const auto whole = one.whole(clamp);
            for (const double memory : {0.0, 1.5e6}) {
                const auto made =
                    one.spooled(clamp, false, memory, mFolder / "x.vdb")->finish(false);
                EXPECT_EQ(bytesOf(made.grid, {}), bytesOf(whole, {}))
                    << one.source->name() << " " << clamp << " " << memory;
                EXPECT_EQ(made.integral, densityIntegral(*whole));
                EXPECT_EQ(made.storedIntegral, made.integral);
                EXPECT_EQ(made.storageError, 0);
                EXPECT_EQ(made.grid->activeVoxelCount(), whole->activeVoxelCount());
            }
        }
    }
}

TEST_F(SpooledAssemblyTest, HasTheBricksOfOneRowAfterTheOther) {
    const Case one(std::make_unique<MeshSource>("ball", ballMesh(1, openvdb::Vec3d(0.1), 7)),
                   {2, 0.16}, 60, 40);
    ASSERT_TRUE(SpreadBricks::payFor(*one.source, one.layout.voxelSize));
    ASSERT_GT(one.layout.count.y(), 2);
    const auto made = one.spooled(false, false, 0, mFolder / "x.vdb")->finish(false);
    EXPECT_EQ(bytesOf(made.grid, {}), bytesOf(one.whole(false), {}));
}

// Whether shells overlap is known only when all columns are filled.
TEST_F(SpooledAssemblyTest, CanBeLimitedInTheEnd) {
    for (const ExponentialFilter& filter :
         {ExponentialFilter{2, 0.16}, ExponentialFilter{4, 0.28}}) {
        const Case one(overlappingBalls(), filter, 80, 40);
        for (const bool rounds : {false, true}) {
            const auto whole = one.whole(/*clamp=*/true);
            const double change = rounds ? roundToHalf(*whole) : 0;
            const auto made =
                one.spooled(/*clamp=*/false, rounds, 0, mFolder / "x.vdb")->finish(/*limit=*/true);
            VdbWriteOptions options;
            options.half = rounds;
            EXPECT_EQ(bytesOf(made.grid, options), bytesOf(whole, options)) << rounds;
            EXPECT_EQ(made.storageError, change);
            EXPECT_EQ(made.storedIntegral, densityIntegral(*whole));
        }
    }
}

TEST_F(SpooledAssemblyTest, RoundsAsTheWholeIsRounded) {
    const Case one(makeShapeBoundary("shape:torus"), {4, 0.25}, 120, 48);
    const auto exact = one.whole(false);
    const double integral = densityIntegral(*exact);
    const double change = roundToHalf(*exact);
    const auto made = one.spooled(false, true, 0, mFolder / "x.vdb")->finish(false);
    // What was no tile before has been summed up in another order.
    EXPECT_NEAR(made.integral, integral, 1e-12 * integral);
    EXPECT_EQ(made.storedIntegral, densityIntegral(*exact));
    EXPECT_EQ(made.storageError, change);
    EXPECT_GT(change, 0);
    using Compression = VdbWriteOptions::Compression;
    for (const auto compression : {Compression::Blosc, Compression::Zip, Compression::None}) {
        EXPECT_EQ(bytesOf(made.grid, {true, compression}), bytesOf(exact, {true, compression}));
    }
}

TEST_F(SpooledAssemblyTest, CompressesAsTheWholeIs) {
    const Case one(makeShapeBoundary("shape:cube"), {2, 0.16}, 100, 48);
    const auto whole = one.whole(false);
    const auto made = one.spooled(false, false, 0, mFolder / "x.vdb")->finish(false);
    using Compression = VdbWriteOptions::Compression;
    for (const auto compression : {Compression::Zip, Compression::None}) {
        EXPECT_EQ(bytesOf(made.grid, {false, compression}), bytesOf(whole, {false, compression}));
    }
}

TEST_F(SpooledAssemblyTest, ThreadsDoNotChangeABit) {
    const Case one(makeShapeBoundary("shape:torus"), {2, 0.16}, 120, 48);
    std::string bytes[2];
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        const auto made = one.spooled(false, false, 3e6, mFolder / "x.vdb")->finish(false);
        bytes[threads - 1] = bytesOf(made.grid, {});
    }
    EXPECT_EQ(bytes[0], bytes[1]);
}

TEST_F(SpooledAssemblyTest, CopiesOfItsGridAreWrittenAlike) {
    const Case one(makeShapeBoundary("shape:sphere"), {2, 0.16}, 80, 40);
    const auto made = one.spooled(false, false, 0, mFolder / "x.vdb")->finish(false);
    made.grid->insertMeta("a", openvdb::Int32Metadata(1));
    const openvdb::GridBase::ConstPtr grid = made.grid;
    EXPECT_EQ(bytesOf(grid->copyGrid(), {}), bytesOf(grid, {}));
}

TEST_F(SpooledAssemblyTest, LeavesNoFile) {
    const Case one(makeShapeBoundary("shape:sphere"), {2, 0.16}, 80, 40);
    const auto assembly = one.spooled(false, false, 0, mFolder / "x.vdb");
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST_F(SpooledAssemblyTest, SaysThatThereIsNoRoom) {
    const Case one(makeShapeBoundary("shape:sphere"), {2, 0.16}, 80, 40);
    EXPECT_THROW(one.spooled(false, false, 0, mFolder / "none" / "x.vdb"), Error);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit full = before;
    full.rlim_cur = 100'001;  // in the middle of a node
    const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &full);
    std::string said;
    try {
        one.spooled(false, false, 0, mFolder / "x.vdb");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Runtime);
        said = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, ignored);
    EXPECT_NE(said.find("cannot write " + (mFolder / "x.vdb").string()), std::string::npos) << said;
}

}  // namespace
}  // namespace bandvox

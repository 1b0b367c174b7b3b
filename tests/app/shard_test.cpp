// Parts of a volume that convert makes, and merge joins.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class ShardCommand : public testing::Test {
  protected:
    RunResult run(const Names& arguments) {
        return runBandvox(arguments, {.folder = mFolder.path()});
    }

    // Makes the whole by `arguments`, and three parts that are merged.
    void makeBoth(Names arguments) {
        SCOPED_TRACE(arguments.front());
        arguments.insert(arguments.begin(), "convert");
        Names whole = arguments;
        whole.insert(whole.end(), {"-o", "whole.vdb"});
        const RunResult made = run(whole);
        ASSERT_EQ(made.status, 0) << made.err;
        for (const char* part : {"3", "1", "2"}) {
            Names some = arguments;
            some.insert(some.end(), {"-o", std::string("part") + part + ".vdb", "--shard",
                                     std::string(part) + "/3"});
            const RunResult result = run(some);
            ASSERT_EQ(result.status, 0) << result.err;
        }
        const RunResult merged =
            run({"merge", "part2.vdb", "part3.vdb", "part1.vdb", "-o", "joined.vdb"});
        ASSERT_EQ(merged.status, 0) << merged.err;
    }

    // Every voxel, and what the grids say of themselves.
    void expectSame() {
        const openvdb::GridPtrVec whole = readVdb(mFolder / "whole.vdb");
        const openvdb::GridPtrVec joined = readVdb(mFolder / "joined.vdb");
        ASSERT_EQ(whole.size(), joined.size());
        for (const auto& grid : whole) {
            openvdb::GridBase::Ptr other;
            for (const auto& candidate : joined) {
                if (candidate->getName() == grid->getName()) other = candidate;
            }
            ASSERT_TRUE(other) << grid->getName();
            for (auto entry = grid->beginMeta(); entry != grid->endMeta(); ++entry) {
                if (entry->first == "file_mem_bytes") continue;
                const auto same = (*other)[entry->first];
                ASSERT_TRUE(same) << entry->first;
                EXPECT_EQ(same->str(), entry->second->str()) << entry->first;
            }
            EXPECT_EQ(grid->metaCount(), other->metaCount());
            if (grid->isType<openvdb::FloatGrid>()) {
                expectSameValues<openvdb::FloatGrid>(*grid, *other);
            } else {
                expectSameValues<openvdb::Vec3SGrid>(*grid, *other);
            }
        }
    }

    template <typename Grid>
    void expectSameValues(const openvdb::GridBase& a, const openvdb::GridBase& b) {
        const auto& whole = dynamic_cast<const Grid&>(a);
        const auto& joined = dynamic_cast<const Grid&>(b);
        EXPECT_TRUE(whole.tree().hasSameTopology(joined.tree()));
        const auto accessor = joined.getConstAccessor();
        for (auto value = whole.cbeginValueOn(); value; ++value) {
            ASSERT_EQ(*value, accessor.getValue(value.getCoord())) << value.getCoord();
        }
    }

    TemporaryFolder mFolder;
};

TEST_F(ShardCommand, PartsOfAMeshWithColoursMergeToTheWhole) {
    writeText(mFolder / "cube.obj", coloredCubeObj());
    makeBoth({"cube.obj", "-r", "150", "--color", "--tile", "48"});
    expectSame();
}

TEST_F(ShardCommand, PartsOfOtherSourcesMergeToTheWhole) {
    makeBoth({"shape:torus", "-r", "120", "--tile", "40", "--half"});
    expectSame();
    ASSERT_EQ(run({"convert", "shape:torus", "-r", "160", "-o", "torus.vdb"}).status, 0);
    makeBoth({"torus.vdb", "--factor", "1.5"});
    expectSame();
    ASSERT_EQ(
        run({"convert", "shape:torus", "-r", "100", "--as", "level-set", "-o", "sdf.vdb"}).status,
        0);
    makeBoth({"sdf.vdb", "--as", "density", "--tile", "32"});
    expectSame();
    const openvdb::GridPtrVec turned = readVdb(mFolder / "sdf.vdb");
    turned.front()->transform().postRotate(0.4, openvdb::math::X_AXIS);
    turned.front()->transform().postRotate(0.7, openvdb::math::Z_AXIS);
    writeVdb(mFolder / "turned.vdb", {turned.front()});
    makeBoth({"turned.vdb", "--as", "density", "--tile", "32"});
    expectSame();
}

TEST_F(ShardCommand, RefusesWhatIsNoWhole) {
    for (const char* part : {"1/3", "2/3", "3/3"}) {
        const std::string output = std::string("part") + part[0] + ".vdb";
        ASSERT_EQ(run({"convert", "shape:torus", "-r", "60", "-o", output, "--shard", part}).status,
                  0);
    }
    ASSERT_EQ(run({"convert", "shape:torus", "-r", "60", "-o", "whole.vdb"}).status, 0);
    ASSERT_EQ(
        run({"convert", "shape:torus", "-r", "61", "-o", "other.vdb", "--shard", "3/3"}).status, 0);
    const auto expect = [&](int status, Names arguments, const std::string& words) {
        arguments.insert(arguments.begin(), "merge");
        arguments.insert(arguments.end(), {"-o", "joined.vdb"});
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(mFolder / "joined.vdb"));
    };
    expect(3, {"part1.vdb", "part3.vdb"}, "missing: 2");
    expect(3, {"part1.vdb", "part1.vdb", "part2.vdb"}, "another file");
    expect(3, {"part1.vdb", "part2.vdb", "other.vdb"}, "lattice");
    expect(3, {"part1.vdb", "whole.vdb"}, "no part");
    expect(3, {"whole.vdb", "part1.vdb"}, "holds a part");
    expect(2, {"part1.vdb", "part2.vdb", "part3.vdb", "--operation", "max"}, "--operation");

    for (const Names& more : {Names{"-o", "cut.ply"}, {"-o", "cut.vdb", "--factor", "2"}}) {
        Names arguments{"convert", "part2.vdb"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_NE(result.err.find("part 2 of 3"), std::string::npos) << result.err;
    }

    const auto refuse = [&](Names arguments, const std::string& words) {
        arguments.insert(arguments.begin(), {"convert", "shape:torus"});
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    };
    refuse({"-o", "no.vdb", "--shard", "0/3"}, "0/3");
    refuse({"-o", "no.ply", "--shard", "1/3"}, "--shard");
    refuse({"-o", "no.vdb", "--shard", "4/3"}, "4/3");
    refuse({"-o", "no.vdb", "--shard", "half"}, "half");
    refuse({"-o", "no.vdb", "--shard", "1/3", "--lod", "2"}, "--lod");
    refuse({"-o", "no.vdb", "--shard", "1/3", "--as", "fog"}, "fog");
    refuse({"-o", "no.vdb", "--shard", "1/3", "--iso", "volume"}, "volume");
    refuse({"-o", "no.ply", "--shard", "1/3"}, "mesh");
}

}  // namespace
}  // namespace bandvox::app_test

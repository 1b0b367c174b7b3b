// What the convert command makes of --tolerance and --strict on the sampled route.

#include "run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

RunResult convertCube(const TemporaryFolder& folder, const Names& more) {
    Names arguments{"convert", "shape:cube", "-o", "a.vdb", "-r", "20", "--route", "sampled"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runBandvox(arguments, {.folder = folder.path()});
}

TEST(SampledRoute, PlainRunDoesNotWarn) {
    const TemporaryFolder folder;
    const RunResult result = convertCube(folder, {"--strict"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("tolerance 0.05"), std::string::npos) << result.err;
}

TEST(SampledRoute, ErrorAboveTheDefaultToleranceIsAWarning) {
    const TemporaryFolder folder;
    const RunResult plain = convertCube(folder, {"--oversample", "2"});
    EXPECT_EQ(plain.status, 0) << plain.err;
    EXPECT_EQ(countLines(plain.err, "bandvox: warning: the sampling error"), 1) << plain.err;
    EXPECT_NE(plain.err.find("tolerance of 0.05;"), std::string::npos) << plain.err;
    std::filesystem::remove(folder / "a.vdb");

    const RunResult strict = convertCube(folder, {"--oversample", "2", "--strict"});
    EXPECT_EQ(strict.status, 4) << strict.err;
    EXPECT_EQ(folder.contents(), Names{});
}

TEST(SampledRoute, ToleranceThatIsAskedForIsKeptOrNothingWritten) {
    const TemporaryFolder folder;
    const RunResult failed = convertCube(folder, {"--oversample", "4", "--tolerance", "0.012"});
    EXPECT_EQ(failed.status, 4) << failed.err;
    EXPECT_NE(failed.err.find("above the tolerance asked for, 0.012"), std::string::npos)
        << failed.err;
    EXPECT_EQ(folder.contents(), Names{});
    EXPECT_EQ(convertCube(folder, {"--oversample", "16", "--tolerance", "0.04"}).status, 0);
}

TEST(SampledRoute, ErrorThatIsNotKnownKeepsToNoTolerance) {
    const TemporaryFolder folder;
    const RunResult failed = convertCube(folder, {"--oversample", "3", "--tolerance", "0.05"});
    EXPECT_EQ(failed.status, 4) << failed.err;
    EXPECT_NE(failed.err.find("not known for an odd --oversample"), std::string::npos)
        << failed.err;
    EXPECT_EQ(folder.contents(), Names{});
}

TEST(SampledRoute, AnotherVolumeThanTheShapesIsAWarning) {
    const TemporaryFolder folder;
    const RunResult few =
        runBandvox({"convert", "shape:sphere", "-o", "a.vdb", "--route", "sampled", "-r", "1"},
                   {.folder = folder.path()});
    EXPECT_EQ(few.status, 0) << few.err;
    EXPECT_EQ(countLines(few.err, "bandvox: warning: the integral"), 1) << few.err;
    const RunResult absurd = runBandvox(
        {"convert", "shape:sphere", "-o", "b.vdb", "--route", "sampled", "--voxel-size", "1e300"},
        {.folder = folder.path()});
    EXPECT_EQ(absurd.status, 2) << absurd.err;
    EXPECT_EQ(folder.contents(), Names{"a.vdb"});
}

TEST(SampledRoute, ErrorThatIsNotKnownIsAWarning) {
    const TemporaryFolder folder;
    const RunResult result = convertCube(folder, {"--oversample", "3", "--stats", "s.json"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: warning: "), 1) << result.err;
    const auto counts = nlohmann::json::parse(readText(folder / "s.json")).at("counts");
    EXPECT_TRUE(counts.at("sampling_error").is_null());
    EXPECT_GT(counts.at("field_samples").get<double>(), 60 * 60 * 60);
    const RunResult info = runBandvox({"info", "a.vdb", "--json"}, {.folder = folder.path()});
    const auto own = nlohmann::json::parse(info.out).at("grids").at(0).at("bandvox");
    EXPECT_TRUE(own.at("sampling_error").is_null());
    EXPECT_NEAR(own.at("source_volume").get<double>(), 8, 1e-9);
}

}  // namespace
}  // namespace bandvox::app_test

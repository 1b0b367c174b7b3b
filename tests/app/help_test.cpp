// Help, version, and what is said about wrong usage.

#include "run_command.h"

#include <gtest/gtest.h>

#include <sstream>

namespace bandvox::app_test {
namespace {

using Arguments = std::vector<std::string>;

/// Expects exit 2, nothing on the standard output, and one line that holds `words`.
void expectUsageError(const Arguments& arguments, const std::vector<std::string>& words) {
    const TemporaryFolder folder;
    const RunResult result = runBandvox(arguments, {.folder = folder.path()});
    SCOPED_TRACE(testing::PrintToString(arguments) + " said: " + result.err);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1);
    EXPECT_EQ(countLines(result.err, ""), 1);
    for (const std::string& word : words) {
        EXPECT_NE(result.err.find(word), std::string::npos) << word;
    }
    EXPECT_EQ(folder.contents(), Arguments{});
}

TEST(Help, ListsTheCommands) {
    const RunResult bare = runBandvox({});
    EXPECT_EQ(bare.status, 0);
    EXPECT_EQ(bare.err, "");
    for (const char* word : {"convert", "voxelize", "fit", "render", "outline", "info", "compare",
                             "merge", "view", "Exit status", "130"}) {
        EXPECT_NE(bare.out.find(word), std::string::npos) << word;
    }
    for (const Arguments& arguments : {Arguments{"--help"}, {"-h"}, {"help"}}) {
        const RunResult result = runBandvox(arguments);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.out, bare.out);
    }
}

TEST(Help, ExplainsEveryCommand) {
    for (const std::string command :
         {"convert", "voxelize", "fit", "render", "outline", "info", "compare", "merge", "view"}) {
        const RunResult result = runBandvox({"help", command});
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
        EXPECT_EQ(countLines(result.out, "Usage: bandvox " + command), 1);
        for (const char* option : {"--threads", "--quiet", "--verbose", "--progress", "--stats",
                                   "--strict", "--help", "--version", "Examples"}) {
            EXPECT_NE(result.out.find(option), std::string::npos) << option;
        }
        EXPECT_EQ(runBandvox({command, "--help"}).out, result.out);
        EXPECT_EQ(runBandvox({command, "-h"}).out, result.out);
    }
    EXPECT_NE(runBandvox({"help", "convert"}).out.find("--resolution N"), std::string::npos);
    EXPECT_NE(runBandvox({"help", "render"}).out.find("--samples N"), std::string::npos);
    EXPECT_NE(runBandvox({"help", "info"}).out.find("--json"), std::string::npos);
}

TEST(Help, FitsATerminal) {
    for (const std::string command :
         {"convert", "voxelize", "fit", "render", "outline", "info", "compare", "merge", "view"}) {
        std::istringstream lines(runBandvox({"help", command}).out);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    }
}

TEST(Version, IsOneLine) {
    const RunResult result = runBandvox({"--version"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(countLines(result.out, "bandvox "), 1);
    EXPECT_EQ(runBandvox({"info", "--version"}).out, result.out);
}

TEST(Usage, SuggestsTheNearestName) {
    expectUsageError({"convrt", "shape:cube"}, {"'convrt'", "'convert'"});
    expectUsageError({"--resolution"}, {"unknown option", "--resolution"});
    expectUsageError({"zzz"}, {"'zzz'", "--help"});
    expectUsageError({"convert", "shape:cube", "-o", "a.vdb", "--resolutoin", "32"},
                     {"--resolutoin", "'--resolution'"});
    expectUsageError({"render", "a.vdb", "--sampels=4"}, {"--sampels", "'--samples'"});
    expectUsageError({"info", "a.vdb", "--xyzzy"}, {"--xyzzy", "--help"});
    expectUsageError({"help", "rendr"}, {"'render'"});
    expectUsageError({"help", "info", "render"}, {"'render'"});
}

TEST(Usage, DoesNotGuessAbbreviations) {
    expectUsageError({"convert", "shape:cube", "-o", "a.vdb", "--res", "32"},
                     {"--res", "'--resolution'"});
    expectUsageError({"info", "a.vdb", "--js"}, {"--js", "'--json'"});
}

TEST(Usage, ChecksArgumentsAndValues) {
    expectUsageError({"convert", "-o", "a.vdb"}, {"INPUT"});
    expectUsageError({"convert", "a.obj", "b.obj", "-o", "a.vdb"}, {"b.obj"});
    expectUsageError({"convert", "shape:cube"}, {"-o"});
    expectUsageError({"convert", "shape:cube", "-o", ""}, {});
    expectUsageError({"convert", "shape:cube", "-o"}, {"--output"});
    expectUsageError({"convert", "shape:cube", "-o", "a.off"}, {"a.off", ".vdb", ".ply"});
    expectUsageError({"convert", "shape:cube", "-o", "a"}, {"'a'", ".vdb"});
    expectUsageError({"convert", "shape:cube", "-o", "a.vdb", "--half", "--half"}, {"--half"});
    expectUsageError({"convert", "shape:cube", "-o", "a.vdb", "--half=yes"}, {"--half"});
    expectUsageError({"convert", "shape:cube", "-o", "a.vdb", "--tile"}, {"--tile"});
    expectUsageError({"render", "a.vdb", "-o", "a.jpg"}, {"a.jpg", ".png", ".exr"});
    expectUsageError({"info", "a.vdb", "--quiet", "--verbose"}, {"--quiet", "--verbose"});
    expectUsageError({"info", "a.vdb", "--progress", "yes"}, {"yes", "auto, always, never"});
    expectUsageError({"info", "a.vdb", "--threads", "-1"}, {"--threads", "'-1'"});
    expectUsageError({"info", "a.vdb", "--threads", "two"}, {"--threads", "'two'"});
    expectUsageError({"info", "a.vdb", "--stats", ""}, {"--stats"});
}

TEST(Usage, ReadsNumbersStrictly) {
    const auto convert = [](const std::string& option, const std::string& value) {
        expectUsageError({"convert", "shape:cube", "-o", "a.vdb", option, value},
                         {option, "'" + value + "'", "expected"});
    };
    for (const char* value : {"0", "-5", "nan", "inf", "1e99", "12x", "1.5", " 3", "0x10",
                              "99999999999999999999", "1000001"}) {
        convert("--resolution", value);
    }
    for (const char* value : {"0", "-1", "nan", "inf", "-inf", "1e999", "1,5", "0.1m"}) {
        convert("--voxel-size", value);
    }
    convert("--cutoff", "0.51");
    convert("--cutoff", "0");
    convert("--order", "65");
    convert("--tolerance", "1e-7");
    convert("--tolerance", "0.1");
    for (const char* value : {"-1", "17", "514", "1024"}) convert("--tile", value);
    convert("--iso", "0");
    convert("--iso", "1");
    convert("--compression", "lzma");
    expectUsageError(
        {"convert", "shape:cube", "-o", "a.vdb", "--resolution", "9", "--voxel-size", "1"},
        {"--resolution", "--voxel-size"});
}

TEST(Usage, ReadsVectorsStrictly) {
    const auto render = [](const std::string& option, const std::string& value) {
        expectUsageError({"render", "a.vdb", "-o", "a.png", option, value},
                         {option, "'" + value + "'", "expected"});
    };
    for (const char* value : {"1", "1,2", "1,2,3,4", "1,2,", ",,", "1,2,x", "1,nan,2", "1 2 3"}) {
        render("--eye", value);
    }
    render("--color", "-1,0,0");
    render("--ambient", "1.5");
    for (const char* value : {"0x5", "5x0", "640", "640x", "640x480x2", "65537x1", "-1x1"}) {
        render("--res", value);
    }
    render("--samples", "0");
    render("--focal", "0");
    render("--aperture", "-1");
    render("--frame", "-1");
    render("--camera", "fisheye");
    render("--shading", "gouraud");
}

}  // namespace
}  // namespace bandvox::app_test

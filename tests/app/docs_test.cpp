// The pages in docs/ show code and output that are those of the examples.

#include "build_places.h"
#include "run_command.h"

#include <gtest/gtest.h>

#include <sstream>

namespace bandvox::app_test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = build_places::sources();

std::vector<fs::path> pages() {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs")) {
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    }
    return found;
}

// Every line without what it is indented by.
std::string withoutIndent(const std::string& text) {
    std::string result;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t begin = line.find_first_not_of(' ');
        if (begin != std::string::npos) result += line.substr(begin);
        result += '\n';
    }
    return result;
}

// The blocks of a page that are fenced as "```LANGUAGE".
std::vector<std::string> blocksOf(const std::string& text, const std::string& language) {
    std::vector<std::string> blocks;
    const std::string fence = "\n```" + language + "\n";
    for (std::size_t at = 0; (at = text.find(fence, at)) != std::string::npos;) {
        at += fence.size();
        blocks.push_back(text.substr(at, text.find("\n```", at) + 1 - at));
    }
    return blocks;
}

TEST(Docs, CodeIsThatOfTheExamples) {
    std::string examples;
    for (const auto& entry : fs::directory_iterator(kRoot / "examples")) {
        if (entry.path().extension() != ".cpp") continue;
        examples += withoutIndent(readText(entry.path()));
    }
    int blocks = 0;
    for (const fs::path& page : pages()) {
        for (const std::string& block : blocksOf(readText(page), "cpp")) {
            EXPECT_NE(examples.find(withoutIndent(block)), std::string::npos) << page << block;
            ++blocks;
        }
    }
    EXPECT_GT(blocks, 0);
}

// Where the examples are not built, there is nothing to run.
#ifdef BANDVOX_WITH_SHAPE_TO_SCREEN

TEST(Docs, ShapeToScreenSaysWhatThePageShows) {
    const RunResult result = runProgram({build_places::shapeToScreen(), "shape:torus"});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::vector<std::string> shown =
        blocksOf(readText(kRoot / "docs/math/pruned-transforms.md"), "text");
    ASSERT_EQ(shown.size(), 1u);
    EXPECT_EQ(result.out, shown[0]);
}

TEST(Docs, ShapeToScreenRefusesWhatItDoesNotKnow) {
    EXPECT_EQ(runProgram({build_places::shapeToScreen()}).status, 2);
    EXPECT_NE(runProgram({build_places::shapeToScreen(), "shape:none"}).status, 0);
}

#endif

}  // namespace
}  // namespace bandvox::app_test

// The example that draws and measures the paper's figures.

#include "run_command.h"

#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

// Where the examples are not built, there is nothing to test.
#ifdef BANDVOX_PAPER_FIGURES

namespace bandvox::app_test {
namespace {

/// Its quick run, once for all tests.
class PaperFigures : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = new TemporaryFolder;
        sResult = runProgram({BANDVOX_PAPER_FIGURES, (*sFolder / "figures").string(), "--quick"});
    }
    static void TearDownTestSuite() {
        delete sFolder;
        sFolder = nullptr;
    }

    static std::filesystem::path file(const std::string& name) {
        return *sFolder / "figures" / name;
    }

    /// The mean error of normals, degrees, in a row of normal_errors.csv that starts so.
    static double meanError(const std::string& start) {
        std::istringstream lines(readText(file("normal_errors.csv")));
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with(start + ",")) continue;
            std::istringstream cells(line.substr(start.size() + 1));
            std::string pixels;
            double mean = -1;
            std::getline(cells, pixels, ',');
            cells >> mean;
            return mean;
        }
        ADD_FAILURE() << "no row starts with " << start;
        return -1;
    }

    static TemporaryFolder* sFolder;
    static RunResult sResult;
};

TemporaryFolder* PaperFigures::sFolder = nullptr;
RunResult PaperFigures::sResult;

TEST_F(PaperFigures, LeavesSheetsPicturesAndTables) {
    ASSERT_EQ(sResult.status, 0) << sResult.err;
    for (const char* name :
         {"figures_1_to_5", "figure_8", "figure_9", "figure_10_balls", "figure_10_tree"}) {
        const OIIO::ImageBuf sheet(file(std::string(name) + ".png").string());
        EXPECT_GT(sheet.spec().width, 900) << name;
    }
    for (const char* name : {"normal_errors", "roughness"}) {
        const std::string csv = readText(file(std::string(name) + ".csv"));
        const std::string markdown = readText(file(std::string(name) + ".md"));
        EXPECT_GT(countLines(csv, "cube,spectral,"), 5) << name;
        EXPECT_EQ(countLines(markdown, "| cube | spectral |"), countLines(csv, "cube,spectral,"));
    }
    EXPECT_GT(countLines(readText(file("variants.csv")), "\"filter ("), 8);

    const OIIO::ImageBuf picture(file("figure_8_sphere_front.exr").string());
    const std::vector<std::string>& channels = picture.spec().channelnames;
    for (const char* channel : {"R", "A", "Z", "N.X", "N.Z", "P.X", "P.Z"}) {
        EXPECT_NE(std::find(channels.begin(), channels.end(), channel), channels.end()) << channel;
    }
    // The middle faces the eye, which looks along +z.
    const int nz =
        static_cast<int>(std::find(channels.begin(), channels.end(), "N.Z") - channels.begin());
    EXPECT_NEAR(picture.getchannel(31, 31, 0, nz), -1, 1e-3);
}

TEST_F(PaperFigures, NormalsOfASphereAreAsGoodAsThePaperSays) {
    ASSERT_EQ(sResult.status, 0) << sResult.err;
    EXPECT_LT(meanError("sphere,spectral,64,8"), 1);
    EXPECT_LT(meanError("sphere,spectral,256,32"), 0.1);
    EXPECT_GT(meanError("sphere,sobel3d,64,64"), 6);
    // R = 4 N is enough, less is not.
    EXPECT_LT(meanError("sphere,spectral,64,16"), 0.5);
    EXPECT_GT(meanError("sphere,spectral,16,16"), 2);
}

TEST(PaperFiguresUsage, RefusesOtherArguments) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"out", "--fast"}, {"--quick"}}) {
        std::vector<std::string> command{BANDVOX_PAPER_FIGURES};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const RunResult result = runProgram(command);
        EXPECT_EQ(result.status, 2);
        EXPECT_NE(result.err.find("usage: paper_figures"), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace bandvox::app_test

#endif

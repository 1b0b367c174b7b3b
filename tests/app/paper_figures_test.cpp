// The example that draws and measures the paper's figures.

#include "build_places.h"
#include "run_command.h"

#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

// Where the examples are not built, there is nothing to test.
#ifdef BANDVOX_WITH_PAPER_FIGURES

namespace bandvox::app_test {
namespace {

/// Its quick run, once for all tests.
class PaperFigures : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = new TemporaryFolder;
        sResult =
            runProgram({build_places::paperFigures(), (*sFolder / "figures").string(), "--quick"});
    }
    static void TearDownTestSuite() {
        delete sFolder;
        sFolder = nullptr;
    }

    static std::filesystem::path file(const std::string& name) {
        return *sFolder / "figures" / name;
    }

    /// The numbers that follow `start` in that row of a table; none, and a failure, if there is no
    /// such row.
    static std::vector<double> numbersAfter(const std::string& table, const std::string& start) {
        std::istringstream lines(readText(file(table)));
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with(start + ",")) continue;
            std::istringstream cells(line.substr(start.size() + 1));
            std::vector<double> numbers;
            for (std::string cell; std::getline(cells, cell, ',');) {
                numbers.push_back(std::stod(cell));
            }
            return numbers;
        }
        ADD_FAILURE() << "no row of " << table << " starts with " << start;
        return {};
    }

    /// The mean error of normals, degrees, in a row of normal_errors.csv that starts so.
    static double meanError(const std::string& start) {
        return numbersAfter("normal_errors.csv", start).at(1);  // after the pixels
    }

    /// Under the light in front, and under the one at the upper right.
    struct Roughness {
        double front, upperRight;
        double least() const { return std::min(front, upperRight); }
        double most() const { return std::max(front, upperRight); }
    };

    /// How many times as rough as the true picture that of a row of roughness.csv is.
    static Roughness overTrue(const std::string& start) {
        // Triples measured, front, front true, upper right, upper right true.
        const std::vector<double> cells = numbersAfter("roughness.csv", start);
        EXPECT_GT(cells.at(0), 300) << start << ": too few to say anything";
        // Of the curved solids the page gives true ones of 0.0017 to 0.0084. Were they larger, they
        // would hide stripes.
        for (const int truth : {2, 4}) {
            EXPECT_GT(cells.at(truth), 0.001) << start;
            EXPECT_LT(cells.at(truth), 0.010) << start;
        }
        return {cells.at(1) / cells.at(2), cells.at(3) / cells.at(4)};
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

// The limits of the next three tests stand a fifth or so beside what docs/paper.md reports, which
// the comments repeat, so that a method that gets stripes, or loses them, does not pass.
const std::string kCurved[] = {"hyperboloid", "sphere"};

TEST_F(PaperFigures, OlderNormalsAreStriped) {
    ASSERT_EQ(sResult.status, 0) << sResult.err;
    for (const std::string& solid : kCurved) {
        for (const char* method : {"phong", "cross", "sobel2d", "sobel3d"}) {
            // 13 to 55 times.
            const Roughness found = overTrue(solid + "," + method + ",64,64");
            EXPECT_GT(found.least(), 10) << solid << ' ' << method;
            EXPECT_LT(found.most(), 70) << solid << ' ' << method;
        }
        // 7.1 and 9.4 times: more than the paper's method, less than what is striped. Depth knows
        // no lights.
        const Roughness depth = overTrue(solid + ",depth,64,64");
        EXPECT_GT(depth.least(), 6) << solid;
        EXPECT_LT(depth.most(), 11) << solid;
        EXPECT_EQ(depth.front, depth.upperRight) << solid;
    }
}

TEST_F(PaperFigures, SpectralNormalsAreNotStriped) {
    ASSERT_EQ(sResult.status, 0) << sResult.err;
    for (const std::string& solid : kCurved) {
        for (const char* numbers : {"64,8", "64,16", "128,16", "256,32"}) {  // R ≥ 4 N
            // 2.0 to 4.5 times, for depths are rounded to whole steps; refined ones are not.
            const Roughness found = overTrue(solid + ",spectral," + numbers);
            EXPECT_LT(found.most(), 5) << solid << ' ' << numbers;
            EXPECT_GT(found.least(), 1.5) << solid << ' ' << numbers;
        }
        for (const char* numbers : {"64,8", "256,32"}) {
            // 1.0 to 1.4 times; less than the true one would be a picture that is flattened.
            const Roughness found = overTrue(solid + ",\"spectral, refined\"," + numbers);
            EXPECT_LT(found.most(), 1.5) << solid << ' ' << numbers;
            EXPECT_GT(found.least(), 0.95) << solid << ' ' << numbers;
        }
    }
}

TEST_F(PaperFigures, FlatFacesOnlyRing) {
    ASSERT_EQ(sResult.status, 0) << sResult.err;
    const auto underBothLights = [](const std::string& start) {
        const std::vector<double> cells = numbersAfter("roughness.csv", start);
        EXPECT_EQ(cells.at(2), 0) << "the true one of " << start;
        EXPECT_EQ(cells.at(4), 0) << "the true one of " << start;
        return Roughness{cells.at(1), cells.at(3)};
    };
    // 0.05 to 0.31 by the older normals.
    for (const char* method : {"phong", "cross", "sobel2d", "sobel3d"}) {
        EXPECT_GT(underBothLights(std::string("cube,") + method + ",64,64").least(), 0.04);
    }
    // 0.025 by the paper's method at most, 0.032 where it aliases as well.
    for (const char* numbers : {"64,8", "64,16", "128,16", "256,32"}) {
        EXPECT_LT(underBothLights(std::string("cube,spectral,") + numbers).most(), 0.03);
    }
    EXPECT_GT(underBothLights("cube,spectral,16,16").most(), 0.03);
}

TEST(PaperFiguresUsage, RefusesOtherArguments) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"out", "--fast"}, {"--quick"}}) {
        std::vector<std::string> command{build_places::paperFigures()};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const RunResult result = runProgram(command);
        EXPECT_EQ(result.status, 2);
        EXPECT_NE(result.err.find("usage: paper_figures"), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace bandvox::app_test

#endif

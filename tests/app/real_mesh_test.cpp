// The main job on meshes as people have them, where there are some.

#include "run_command.h"

#include <bandvox/grid/density_grid.h>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

namespace bandvox::app_test {
namespace {

/// Which pixels of a picture show something, with a margin of one that does not around them.
struct Silhouette {
    int width = 0, height = 0;
    std::vector<char> seen;

    char& at(int x, int y) { return seen[static_cast<std::size_t>(y + 1) * (width + 2) + x + 1]; }
    int neighbours(int x, int y) {
        return at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1);
    }
};

Silhouette readSilhouette(const std::filesystem::path& path) {
    Silhouette result;
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) {
        ADD_FAILURE() << OIIO::geterror();
        return result;
    }
    const OIIO::ImageSpec spec = input->spec();
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()));
    result.width = spec.width;
    result.height = spec.height;
    result.seen.resize(static_cast<std::size_t>(spec.width + 2) * (spec.height + 2));
    for (int y = 0; y < spec.height; ++y) {
        for (int x = 0; x < spec.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * spec.width + x;
            result.at(x, y) = pixels[pixel * spec.nchannels + 3] > 0.5F;
        }
    }
    return result;
}

/// Removes what is connected to a pixel that shows something.
void erase(Silhouette& picture, int x, int y) {
    std::vector<std::pair<int, int>> open{{x, y}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (picture.at(i, j) == 0) continue;
        picture.at(i, j) = 0;
        for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            open.emplace_back(i + di, j + dj);
        }
    }
}

TEST(RealMesh, TheBunnyBecomesASolidAndAPictureWithoutStreaks) {
    const char* data = std::getenv("BANDVOX_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    const std::filesystem::path mesh = std::filesystem::path(data) / "stanford-bunny.obj";
    const TemporaryFolder folder;
    const RunResult converted = runBandvox(
        {"convert", mesh.string(), "-o", "bunny.vdb", "-r", "128"}, {.folder = folder.path()});
    ASSERT_EQ(converted.status, 0) << converted.err;
    const auto metadata = densityMetadata(*readVdb(folder / "bunny.vdb").at(0));
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->holesCapped, 5);
    EXPECT_NEAR(metadata->gridVolume / metadata->sourceVolume, 1, 1e-4);
    EXPECT_FALSE(metadata->clamped);

    const RunResult rendered = runBandvox(
        {"render", "bunny.vdb", "-o", "bunny.png", "--res", "240x240"}, {.folder = folder.path()});
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    Silhouette picture = readSilhouette(folder / "bunny.png");
    const auto seen = std::accumulate(picture.seen.begin(), picture.seen.end(), 0);
    EXPECT_GT(seen, 240 * 240 / 5);

    // A streak is a thin line: of its pixels only those before and behind show something, too. And
    // the bunny is one piece.
    int thin = 0;
    int pieces = 0;
    Silhouette rest = picture;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            if (picture.at(x, y) != 0 && picture.neighbours(x, y) < 2) ++thin;
            if (rest.at(x, y) != 0) {
                erase(rest, x, y);
                ++pieces;
            }
        }
    }
    EXPECT_EQ(pieces, 1);
    EXPECT_LE(thin, 2);
}

}  // namespace
}  // namespace bandvox::app_test

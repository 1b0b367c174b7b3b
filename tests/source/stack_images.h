#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace bandvox {

/// A folder of its own for each test, removed at the end.
class StackFolder : public testing::Test {
  protected:
    void SetUp() override {
        mFolder =
            std::filesystem::temp_directory_path() / ("bandvox-stack-" + std::to_string(getpid()));
        std::filesystem::create_directories(mFolder);
    }
    void TearDown() override { std::filesystem::remove_all(mFolder); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(mFolder / name, std::ios::binary) << bytes;
        return mFolder / name;
    }

    std::filesystem::path mFolder;
};

/// What is written to an image, and how.
struct TestImage {
    int width = 5, height = 3, channels = 1;
    OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
    std::vector<std::pair<std::string, std::string>> texts;  ///< attributes
    std::vector<std::pair<std::string, int>> numbers;        ///< the same
    std::vector<std::pair<std::string, float>> decimals;     ///< the same
    int tile = 0;                                            ///< its side; 0: none
};

/// Writes pages of values (x, y, channel, page), as they are.
template <typename Stored>
void writeTestImage(const std::filesystem::path& path, const TestImage& image, int pages,
                    const std::function<Stored(int x, int y, int channel, int page)>& value) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, image.type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const auto& [name, text] : image.texts) spec.attribute(name, text);
    for (const auto& [name, number] : image.numbers) spec.attribute(name, number);
    for (const auto& [name, number] : image.decimals) spec.attribute(name, number);
    spec.tile_width = spec.tile_height = image.tile;
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output) << OIIO::geterror();
    for (int page = 0; page < pages; ++page) {
        std::vector<Stored> values;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                for (int c = 0; c < image.channels; ++c) values.push_back(value(x, y, c, page));
            }
        }
        ASSERT_TRUE(
            output->open(path.string(), spec,
                         page == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage))
            << output->geterror();
        ASSERT_TRUE(output->write_image(image.type, values.data())) << output->geterror();
    }
    ASSERT_TRUE(output->close()) << output->geterror();
}

}  // namespace bandvox

#include "stop_after.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/render/image.h>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using bandvox::Error;
using bandvox::ErrorKind;
using bandvox::Image;

// A folder that lives as long as a test.
class ImageFile : public testing::Test {
  protected:
    void SetUp() override {
        mFolder = fs::temp_directory_path() / ("bandvox-image-" + std::to_string(getpid()));
        fs::create_directories(mFolder);
    }
    void TearDown() override { fs::remove_all(mFolder); }

    std::size_t filesInFolder() const {
        return std::distance(fs::directory_iterator(mFolder), fs::directory_iterator());
    }

    fs::path mFolder;
};

// Pixel p has values that tell it from others; pixel 0 saw nothing.
Image sampleImage(int width, int height) {
    Image image;
    image.width = width;
    image.height = height;
    for (int p = 0; p < width * height; ++p) {
        const float alpha = p == 0 ? 0.0F : p == 1 ? 0.5F : 1.0F;
        const float shade = static_cast<float>(p) / static_cast<float>(width * height);
        for (const float c : {shade, 0.5F * shade, 0.25F}) image.color.push_back(alpha * c);
        image.color.push_back(alpha);
        image.depth.push_back(p == 0 ? std::numeric_limits<float>::infinity() : 100.1F + shade);
        for (int c = 0; c < 3; ++c) {
            image.normal.push_back(p == 0 ? 0 : shade - static_cast<float>(c));
            image.position.push_back(p == 0 ? 0 : 1000.01F * static_cast<float>(c) + shade);
        }
    }
    image.metadata.emplace_back("Software", std::string("Bandvox test"));
    image.metadata.emplace_back("bandvox_iso", 0.5);
    return image;
}

TEST_F(ImageFile, WritesEveryChannelOfAnExr) {
    const Image image = sampleImage(7, 5);
    writeImage(mFolder / "picture.EXR", image);
    const auto input = OIIO::ImageInput::open((mFolder / "picture.EXR").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    ASSERT_EQ(spec.width, 7);
    ASSERT_EQ(spec.height, 5);
    EXPECT_EQ(spec.get_string_attribute("Software"), "Bandvox test");
    EXPECT_EQ(spec.get_float_attribute("bandvox_iso"), 0.5F);
    std::vector<float> data(std::size_t(35) * spec.nchannels);
    ASSERT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, data.data()));

    std::map<std::string, int> channels;
    for (int c = 0; c < spec.nchannels; ++c) channels[spec.channelnames[c]] = c;
    const auto expect = [&](const char* name, OIIO::TypeDesc type, const std::vector<float>& from,
                            int width, int at, double error) {
        ASSERT_TRUE(channels.count(name)) << name;
        EXPECT_EQ(spec.channelformat(channels[name]), type) << name;
        for (int p = 0; p < 35; ++p) {
            const float found = data[std::size_t(p) * spec.nchannels + channels[name]];
            const float expected = from[std::size_t(p) * width + at];
            if (std::isinf(expected)) {
                EXPECT_EQ(found, expected) << name;
            } else {
                EXPECT_NEAR(found, expected, error) << name;
            }
        }
    };
    const char* const colors[] = {"R", "G", "B", "A"};
    const char* const normals[] = {"N.X", "N.Y", "N.Z"};
    const char* const positions[] = {"P.X", "P.Y", "P.Z"};
    for (int c = 0; c < 4; ++c) {
        expect(colors[c], OIIO::TypeDesc::HALF, image.color, 4, c, 5e-4);
    }
    expect("Z", OIIO::TypeDesc::FLOAT, image.depth, 1, 0, 0);
    for (int c = 0; c < 3; ++c) {
        expect(normals[c], OIIO::TypeDesc::FLOAT, image.normal, 3, c, 0);
        expect(positions[c], OIIO::TypeDesc::FLOAT, image.position, 3, c, 0);
    }
    EXPECT_EQ(channels.size(), 11u);
}

// libpng itself would speak of the rows that are missing.
TEST_F(ImageFile, APngThatIsGivenUpLeavesNothingAndSaysNothing) {
    const Image image = sampleImage(90, 200);
    for (int strips = 0; strips < 4; ++strips) {
        bandvox::StopAfter progress(strips);
        testing::internal::CaptureStderr();
        try {
            bandvox::AtomicFile file(mFolder / "picture.png");
            writeImage(file, image, {}, progress);
            ADD_FAILURE() << "nothing was thrown after " << strips;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Interrupted) << error.what();
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << strips;
        EXPECT_EQ(filesInFolder(), 0u);
    }
}

TEST_F(ImageFile, WritesTheChannelsAskedFor) {
    using bandvox::ImageChannels;
    struct Case {
        ImageChannels channels;
        std::vector<std::string> names;  // in the order of the alphabet
    };
    const Case cases[] = {{{true, false, false, false}, {"A", "B", "G", "R"}},
                          {{false, true, false, false}, {"Z"}},
                          {{true, true, false, false}, {"A", "B", "G", "R", "Z"}},
                          {{false, false, true, true}, {"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"}}};
    const Image image = sampleImage(7, 5);
    for (const Case& asked : cases) {
        const fs::path path = mFolder / "some.exr";
        writeImage(path, image, asked.channels);
        const auto input = OIIO::ImageInput::open(path.string());
        ASSERT_TRUE(input) << OIIO::geterror();
        std::vector<std::string> names = input->spec().channelnames;
        std::sort(names.begin(), names.end());
        EXPECT_EQ(names, asked.names);
        std::vector<float> data(std::size_t(35) * names.size());
        ASSERT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, data.data()));
        if (names.size() == 1) {
            EXPECT_EQ(data, image.depth);
        }
        // A .png has colour whatever is asked for.
        writeImage(mFolder / "some.png", image, asked.channels);
    }
    EXPECT_THROW(writeImage(mFolder / "none.exr", image, {false, false, false, false}), Error);
    EXPECT_FALSE(fs::exists(mFolder / "none.exr"));
}

TEST_F(ImageFile, WritesAPngInSrgbWithAlphaBeside) {
    const Image image = sampleImage(16, 16);
    writeImage(mFolder / "picture.png", image);
    OIIO::ImageSpec asIs;
    asIs.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open((mFolder / "picture.png").string(), &asIs);
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
    EXPECT_EQ(input->spec().get_string_attribute("Software"), "Bandvox test");
    ASSERT_EQ(input->spec().nchannels, 4);
    std::vector<std::uint8_t> data(16 * 16 * 4);
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, data.data()));
    EXPECT_EQ(data[3], 0);
    EXPECT_EQ(data[4 + 3], 128);
    // Half covered and opaque pixels show the same blue: linear 0.25 is 137 in sRGB.
    EXPECT_EQ(data[4 + 2], 137);
    EXPECT_EQ(data[4 * 200 + 2], 137);
    EXPECT_EQ(data[4 * 128], 188);  // linear 0.5
    EXPECT_EQ(data[4 * 200 + 3], 255);
}

TEST_F(ImageFile, KeepsColorsOutOfRangeInAnExrAndLimitsThemInAPng) {
    Image image = sampleImage(2, 2);
    image.color[12] = 20;
    image.color[13] = -1;
    writeImage(mFolder / "picture.exr", image);
    writeImage(mFolder / "picture.png", image);
    std::vector<std::uint8_t> data(16);
    const auto png = OIIO::ImageInput::open((mFolder / "picture.png").string());
    ASSERT_TRUE(png && png->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, data.data()));
    EXPECT_EQ(data[12], 255);
    EXPECT_EQ(data[13], 0);
    std::vector<float> half(4 * 11);
    const auto exr = OIIO::ImageInput::open((mFolder / "picture.exr").string());
    ASSERT_TRUE(exr && exr->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, half.data()));
    const auto& names = exr->spec().channelnames;
    const auto red = std::find(names.begin(), names.end(), "R") - names.begin();
    EXPECT_EQ(half[3 * 11 + red], 20);
}

TEST_F(ImageFile, RefusesOtherExtensionsAndIncompleteImages) {
    EXPECT_TRUE(bandvox::isImageFile("a/b.PNG"));
    EXPECT_TRUE(bandvox::isImageFile("b.exr"));
    EXPECT_FALSE(bandvox::isImageFile("b.jpg"));
    EXPECT_FALSE(bandvox::isImageFile("png"));
    Image noDepth = sampleImage(3, 3);
    noDepth.depth.pop_back();
    const auto kind = [&](const fs::path& path, const Image& image) {
        try {
            bandvox::writeImage(path, image);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << path << " was written";
        return ErrorKind::Result;
    };
    EXPECT_EQ(kind(mFolder / "a.jpg", sampleImage(3, 3)), ErrorKind::Usage);
    EXPECT_EQ(kind(mFolder / "a.exr", noDepth), ErrorKind::Usage);
    EXPECT_EQ(kind(mFolder / "a.png", Image()), ErrorKind::Usage);
    EXPECT_EQ(kind(mFolder / "none" / "a.png", sampleImage(3, 3)), ErrorKind::Runtime);
    EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(ImageFile, WritesLongPicturesStripByStrip) {
    const Image image = sampleImage(3, 200);
    for (const char* name : {"tall.exr", "tall.png"}) {
        writeImage(mFolder / name, image);
        const auto input = OIIO::ImageInput::open((mFolder / name).string());
        ASSERT_TRUE(input) << OIIO::geterror();
        const int channels = input->spec().nchannels;
        std::vector<float> data(std::size_t(600) * channels);
        ASSERT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, data.data()));
        const auto& names = input->spec().channelnames;
        const auto blue = std::find(names.begin(), names.end(), "B") - names.begin();
        const auto red = std::find(names.begin(), names.end(), "R") - names.begin();
        for (std::size_t p = 2; p < 600; ++p) {
            const float last = p == 2 ? -1.0F : data[(p - 1) * channels + red];
            EXPECT_GE(data[p * channels + red], last) << name << p;
            EXPECT_EQ(data[p * channels + blue], data[2 * channels + blue]) << name << p;
        }
    }
}

// The memory that a picture takes while it is written is hardly more than the picture's own.
TEST_F(ImageFile, TakesLittleMemory) {
#ifdef BANDVOX_SANITIZED
    GTEST_SKIP() << "the sanitizers keep memory that was given back";
#endif
    Image image;
    image.width = 2000;
    image.height = 1000;
    image.color.assign(8'000'000, 0.5F);
    image.depth.assign(2'000'000, 1.0F);
    image.normal.assign(6'000'000, 1.0F);
    image.position.assign(6'000'000, 1.0F);
    for (const char* name : {"large.png", "large.exr"}) {
        writeImage(mFolder / "warm.png", sampleImage(2, 2));
        writeImage(mFolder / "warm.exr", sampleImage(2, 2));
        const std::int64_t before = bandvox::peakMemory();
        writeImage(mFolder / name, image);
        EXPECT_LT(bandvox::peakMemory() - before, 40'000'000) << name;
    }
}

TEST_F(ImageFile, WritesAPipeFromStartToEnd) {
    ASSERT_EQ(mkfifo((mFolder / "pipe.exr").c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] {
        std::ifstream pipe(mFolder / "pipe.exr", std::ios::binary);
        received.assign(std::istreambuf_iterator<char>(pipe), {});
    });
    writeImage(mFolder / "pipe.exr", sampleImage(7, 5));
    reader.join();
    writeImage(mFolder / "file.exr", sampleImage(7, 5));
    std::ifstream file(mFolder / "file.exr", std::ios::binary);
    EXPECT_EQ(received, std::string(std::istreambuf_iterator<char>(file), {}));
    EXPECT_FALSE(received.empty());
}

TEST_F(ImageFile, LeavesTheOldFileWhenTheDiskIsFull) {
    const fs::path path = mFolder / "picture.exr";
    writeImage(path, sampleImage(2, 2));
    const auto before = fs::file_size(path);

    // A limit on the size of files fails writes as a full disk does.
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit low{16384, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &low);
    ErrorKind kind = ErrorKind::Result;
    std::string message;
    try {
        bandvox::writeImage(path, sampleImage(256, 256));
    } catch (const Error& error) {
        kind = error.kind();
        message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, oldHandler);
    EXPECT_EQ(kind, ErrorKind::Runtime);
    EXPECT_NE(message.find("too large"), std::string::npos) << message;
    EXPECT_EQ(fs::file_size(path), before);
    EXPECT_EQ(filesInFolder(), 1u);
}

}  // namespace

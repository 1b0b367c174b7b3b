// Stacks of images as arrays.

#include "source/stack_images.h"

#include <bandvox/core/error.h>
#include <bandvox/source/array_source.h>

#include <Imath/half.h>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;
using openvdb::Coord;
using openvdb::Vec3d;

int valueOf(int x, int y, int z) {
    return 40 * z + 10 * y + x;
}

std::string named(std::string prefix, const std::string& number, const char* extension) {
    prefix += number;
    return prefix += extension;
}

// All values of an array, z the slowest.
std::vector<float> readAll(ArraySource& source, int together = 3) {
    const auto perSlice = static_cast<std::size_t>(source.info().valuesPerSlice());
    std::vector<float> values(perSlice * static_cast<std::size_t>(source.info().slices()));
    for (int z = 0; z < source.info().slices(); z += together) {
        const int count = std::min(together, source.info().slices() - z);
        source.readSlices({&values[perSlice * static_cast<std::size_t>(z)],
                           perSlice * static_cast<std::size_t>(count)});
    }
    return values;
}

class ImageStack : public StackFolder {
  protected:
    // Slice z of the stack that expectStack expects.
    template <typename Stored>
    void writeSlice(const std::string& name, int z, TestImage image, float factor = 1) const {
        writeTestImage<Stored>(mFolder / name, image, 1, [&](int x, int y, int, int) {
            return static_cast<Stored>(factor * static_cast<float>(valueOf(x, y, z)));
        });
    }

    static void expectStack(const fs::path& path, int slices, const std::string& type,
                            float factor = 1) {
        SCOPED_TRACE(path.string());
        const auto source = openArray(path);
        ASSERT_EQ(source->info().size, Coord(5, 3, slices));
        EXPECT_EQ(source->info().valueType, type);
        const std::vector<float> values = readAll(*source);
        std::size_t i = 0;
        for (int z = 0; z < slices; ++z) {
            for (int y = 0; y < 3; ++y) {
                for (int x = 0; x < 5; ++x, ++i) {
                    ASSERT_EQ(values[i], factor * static_cast<float>(valueOf(x, y, z)))
                        << x << " " << y << " " << z;
                }
            }
        }
        std::vector<float> more(15);
        EXPECT_THROW(source->readSlices(more), Error) << "beyond the end";
    }

    static void expectRefused(const fs::path& path, const std::vector<std::string>& said,
                              const ArrayReadOptions& options = {},
                              ErrorKind kind = ErrorKind::Input) {
        try {
            const auto source = openArray(path, options);
            readAll(*source);
            ADD_FAILURE() << path << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            for (const std::string& words : said) {
                EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
                    << error.what() << "\n  does not say: " << words;
            }
        }
    }
};

TEST_F(ImageStack, ReadsSequencesOfAllTypesAsTheyAreStored) {
    for (int z = 0; z < 4; ++z) {
        std::string number = std::to_string(z + 8);
        number.insert(0, 3 - number.size(), '0');
        writeSlice<std::uint8_t>(named("a", number, ".png"), z, {});
        writeSlice<std::uint16_t>(named("b", number, ".png"), z, {.type = TypeDesc::UINT16}, 300);
        writeSlice<std::uint8_t>(named("c", number, ".tif"), z, {.tile = 16});
        writeSlice<std::int16_t>(named("d", number, ".tif"), z, {.type = TypeDesc::INT16}, -100);
        writeSlice<std::uint16_t>(named("e", number, ".tif"), z,
                                  {.type = TypeDesc::UINT16, .texts = {{"compression", "zip"}}},
                                  300);
        writeSlice<float>(named("f", number, ".tif"), z,
                          {.type = TypeDesc::FLOAT, .texts = {{"compression", "lzw"}}}, 0.1F);
        writeSlice<double>(named("g", number, ".tif"), z, {.type = TypeDesc::DOUBLE}, 0.5F);
        writeSlice<Imath::half>(named("h", number, ".exr"), z, {.type = TypeDesc::HALF}, 0.25F);
        writeSlice<float>(named("i", number, ".exr"), z, {.type = TypeDesc::FLOAT}, -1e6F);
        writeSlice<std::uint8_t>(named("j", number, ".tif"), z, {.numbers = {{"tiff:bigtiff", 1}}});
    }
    expectStack(mFolder / "a###.png", 4, "uint8");
    expectStack(mFolder / "b%03d.png", 4, "uint16", 300);
    expectStack(mFolder / "c###.tif", 4, "uint8");
    expectStack(mFolder / "d###.tif", 4, "int16", -100);
    expectStack(mFolder / "e###.tif", 4, "uint16", 300);
    expectStack(mFolder / "f###.tif", 4, "float32", 0.1F);
    expectStack(mFolder / "g###.tif", 4, "float64", 0.5F);
    expectStack(mFolder / "h###.exr", 4, "float16", 0.25F);
    expectStack(mFolder / "i###.exr", 4, "float32", -1e6F);
    expectStack(mFolder / "j###.tif", 4, "uint8");
    // One image is a stack of one slice.
    EXPECT_EQ(openArray(mFolder / "a008.png")->info().size, Coord(5, 3, 1));
    EXPECT_FALSE(openArray(mFolder / "a008.png")->info().hasTransform);
    expectRefused(mFolder / "k###.tif", {"k###.tif", "no file of such a name"});
    expectRefused(mFolder / "k.tif", {"k.tif", "no such file"});
}

TEST_F(ImageStack, ReadsFoldersInTheOrderOfNumbers) {
    for (int z = 0; z < 12; ++z) {
        writeSlice<std::uint16_t>(named("x2_", std::to_string(z), "_v.TIF"), z,
                                  {.type = TypeDesc::UINT16});
    }
    write("notes.txt", "of the scan");
    write(".hidden.tif", "no image");
    fs::create_directories(mFolder / "more");
    expectStack(mFolder, 12, "uint16");
    const auto info = openArray(mFolder)->info();
    ASSERT_EQ(info.notes.size(), 1U);
    EXPECT_EQ(info.notes[0], "3 entries of the folder were left out: .hidden.tif, more, notes.txt");

    fs::remove(mFolder / "x2_7_v.TIF");
    expectRefused(mFolder, {"x2_0_v.TIF to x2_11_v.TIF", "the number 7 is missing"});
    fs::remove(mFolder / "x2_9_v.TIF");
    expectRefused(mFolder, {"7, 9 are missing"});
    writeSlice<std::uint16_t>("x2_07_v.TIF", 7, {.type = TypeDesc::UINT16});
    writeSlice<std::uint16_t>("x2_7_v.TIF", 7, {.type = TypeDesc::UINT16});
    expectRefused(mFolder, {"x2_07_v.TIF and x2_7_v.TIF have the same number"});
    writeSlice<std::uint8_t>("overview.png", 0, {});
    expectRefused(mFolder, {"several kinds", "1 .png", "12 .tif"});
    fs::remove(mFolder / "overview.png");
    writeSlice<std::uint16_t>("overview.tif", 0, {.type = TypeDesc::UINT16});
    expectRefused(mFolder, {"no sequence", "overview.tif"});
    fs::create_directories(mFolder / "empty");
    expectRefused(mFolder / "empty", {"without images"});
}

TEST_F(ImageStack, TakesEvenStepsOfNumbers) {
    for (int z = 0; z < 3; ++z) {
        writeSlice<std::uint8_t>(named("s", std::to_string(10 * z), ".png"), z, {});
    }
    expectStack(mFolder, 3, "uint8");
    EXPECT_EQ(openArray(mFolder)->info().notes,
              std::vector<std::string>{"the numbers of slices go in steps of 10"});
}

TEST_F(ImageStack, SaysWhichSliceDiffers) {
    writeSlice<std::uint8_t>("s0.tif", 0, {});
    writeSlice<std::uint8_t>("s1.tif", 1, {.width = 6});
    expectRefused(mFolder, {"s1.tif", "6 x 3 pixels of 1 x uint8", "s0.tif 5 x 3"});
    writeSlice<std::uint16_t>("s1.tif", 1, {.type = TypeDesc::UINT16});
    expectRefused(mFolder, {"s1.tif", "1 x uint16", "s0.tif", "1 x uint8"});
    writeTestImage<std::uint8_t>(mFolder / "s1.tif", {}, 2,
                                 [](int, int, int, int) { return std::uint8_t(1); });
    expectRefused(mFolder, {"s1.tif", "2 pages"});
}

TEST_F(ImageStack, ReadsPages) {
    writeTestImage<float>(
        mFolder / "p.tif", {.type = TypeDesc::FLOAT}, 11,
        [](int x, int y, int, int page) { return 0.5F * static_cast<float>(valueOf(x, y, page)); });
    expectStack(mFolder / "p.tif", 11, "float32", 0.5F);
    EXPECT_FALSE(openArray(mFolder / "p.tif")->info().hasTransform);
}

TEST_F(ImageStack, ReadsWhatImageJSaysOfVoxels) {
    const auto zero = [](int, int, int, int) { return std::uint8_t(0); };
    TestImage image;
    image.texts = {{"ImageDescription",
                    "ImageJ=1.53t\nimages=3\nslices=3\nunit=\\u00B5m\nspacing=2.5\nloop=false\n"},
                   {"ResolutionUnit", "none"}};
    image.decimals = {{"XResolution", 4.0F}, {"YResolution", 2.0F}, {"PixelAspectRatio", 0.5F}};
    writeTestImage<std::uint8_t>(mFolder / "i.tif", image, 3, zero);
    auto source = openArray(mFolder / "i.tif");
    EXPECT_TRUE(source->info().hasTransform);
    EXPECT_EQ(source->info().unit, "micron");
    EXPECT_TRUE(source->info().toWorld.transform(Vec3d(1, 1, 1)).eq(Vec3d(0.25, 0.5, 2.5), 1e-6));
    // What is asked for goes before that.
    source->place(Vec3d(1, 2, 3), Vec3d(10, 20, 30));
    EXPECT_TRUE(source->info().toWorld.transform(Vec3d(1, 1, 1)).eq(Vec3d(11, 22, 33), 1e-9));
    EXPECT_THROW(source->place(Vec3d(1, 0, 1), {}), Error);

    writeTestImage<std::uint8_t>(mFolder / "few.tif", image, 2, zero);
    expectRefused(mFolder / "few.tif", {"3 images", "2 pages"});
    image.texts[0].second = "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n";
    writeTestImage<std::uint8_t>(mFolder / "hyper.tif", image, 4, zero);
    expectRefused(mFolder / "hyper.tif", {"2 channels and 1 frames"});
    image.texts[0].second = "ImageJ=1.53t\nimages=2\nslices=2\n";
    writeTestImage<std::uint8_t>(mFolder / "bare.tif", image, 2, zero);
    EXPECT_FALSE(openArray(mFolder / "bare.tif")->info().hasTransform);
}

TEST_F(ImageStack, TakesTheChannelThatIsAskedFor) {
    const auto stored = [](int x, int y, int channel, int) {
        return static_cast<std::uint8_t>(channel == 3 ? 200 : 50 * channel + 10 * y + x);
    };
    writeTestImage<std::uint8_t>(mFolder / "c.png", {.channels = 4}, 1, stored);
    const auto read = [&](const std::string& name, const std::string& channel) {
        ArrayReadOptions options;
        options.channel = channel;
        return readAll(*openArray(mFolder / name, options));
    };
    EXPECT_EQ(read("c.png", "R")[7], 12);
    EXPECT_EQ(read("c.png", "G")[7], 62) << "not multiplied with alpha";
    EXPECT_EQ(read("c.png", "2")[7], 112);
    EXPECT_EQ(read("c.png", "A")[7], 200);
    EXPECT_FLOAT_EQ(read("c.png", "luminance")[7], 0.2126F * 12 + 0.7152F * 62 + 0.0722F * 112);
    expectRefused(mFolder / "c.png", {"c.png", "pixel (0, 0)", "A = 200", "--channel"});
    expectRefused(mFolder / "c.png", {"'N'", "R, G, B, A"}, {.channel = "N"}, ErrorKind::Usage);
    expectRefused(mFolder / "c.png", {"'4'"}, {.channel = "4"}, ErrorKind::Usage);

    // Equal colours are grey; the first that differs is named.
    writeTestImage<std::uint8_t>(
        mFolder / "grey.png", {.channels = 4}, 1,
        [](int x, int y, int c, int) { return std::uint8_t(c == 3 ? 255 : valueOf(x, y, 0)); });
    expectStack(mFolder / "grey.png", 1, "uint8");
    writeTestImage<std::uint16_t>(
        mFolder / "odd.tif", {.channels = 3, .type = TypeDesc::UINT16}, 2,
        [](int x, int y, int c, int page) {
            return std::uint16_t(x == 3 && y == 2 && page == 1 && c == 1 ? 7 : valueOf(x, y, 0));
        });
    expectRefused(mFolder / "odd.tif", {"odd.tif, page 1", "pixel (3, 2)", "G = 7", "R = 23"});
    expectRefused(mFolder / "grey.png", {"series"}, {.series = "1"}, ErrorKind::Usage);
}

// A TIFF file by hand.
struct HandMadeTiff {
    std::uint32_t width = 5, height = 3;
    std::uint16_t bits = 16;
    bool bigEndian = true;
    std::string data;

    std::string bytes() const {
        std::string text = bigEndian ? "MM" : "II";
        put(text, 42, 2);
        put(text, 8 + data.size() + data.size() % 2, 4);
        text += data + std::string(data.size() % 2, '\0');
        const std::vector<std::array<std::uint32_t, 3>> tags{
            {256, 4, width}, {257, 4, height}, {258, 3, bits},
            {259, 3, 1},     {262, 3, 1},      {273, 4, 8},
            {277, 3, 1},     {278, 4, height}, {279, 4, static_cast<std::uint32_t>(data.size())}};
        put(text, tags.size(), 2);
        for (const auto& [tag, type, value] : tags) {
            put(text, tag, 2);
            put(text, type, 2);
            put(text, 1, 4);
            put(text, value, type == 3 ? 2 : 4);
            if (type == 3) put(text, 0, 2);
        }
        put(text, 0, 4);
        return text;
    }

    void put(std::string& text, std::uint64_t number, int size) const {
        for (int i = 0; i < size; ++i) {
            const int shift = 8 * (bigEndian ? size - 1 - i : i);
            text += static_cast<char>(number >> shift & 255);
        }
    }
};

TEST_F(ImageStack, ReadsOtherByteOrdersAndFewBits) {
    HandMadeTiff tiff;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 5; ++x) tiff.put(tiff.data, 300 * valueOf(x, y, 0), 2);
    }
    expectStack(write("big.tif", tiff.bytes()), 1, "uint16", 300);

    const HandMadeTiff bit{8, 2, 1, false, std::string("\xb1\x0f", 2)};
    EXPECT_EQ(readAll(*openArray(write("bit.tif", bit.bytes()))),
              (std::vector<float>{1, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1}));
    const HandMadeTiff twelve{2, 2, 12, false, std::string("\x12\x3f\xff\x00\x1a\xbc", 6)};
    EXPECT_EQ(readAll(*openArray(write("twelve.tif", twelve.bytes()))),
              (std::vector<float>{0x123, 0xfff, 0x001, 0xabc}));
}

TEST_F(ImageStack, RefusesDamagedAndHugeFiles) {
    const std::string some(200, '\7');
    expectRefused(write("huge.tif", HandMadeTiff{100000, 100000, 8, false, some}.bytes()),
                  {"huge.tif", "100000 x 100000", "more than its"});
    expectRefused(write("long.tif", HandMadeTiff{2000000, 1, 8, false, some}.bytes()),
                  {"long.tif", "2e+06"});
    expectRefused(write("large.tif", HandMadeTiff{300, 300, 8, false, some}.bytes()),
                  {"large.tif", "300 x 300", "more than its"});
    expectRefused(write("short.tif", HandMadeTiff{60, 60, 8, false, some}.bytes()),
                  {"short.tif", "to its end"});
    expectRefused(write("no.png", "no image"), {"no.png", "no image that can be read"});
    expectRefused(write("empty.exr", ""), {"empty.exr"});

    writeTestImage<std::uint8_t>(
        mFolder / "whole.tif", {.width = 60, .height = 60, .texts = {{"compression", "none"}}}, 5,
        [](int x, int y, int, int page) {
            return static_cast<std::uint8_t>((x * 7919 + y * 104729 + page * 31) % 251);
        });
    std::ifstream whole(mFolder / "whole.tif", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
    ASSERT_GT(bytes.size(), 10000U);
    // Every cut is noticed, wherever it is.
    for (std::size_t length = 100; length < bytes.size(); length += 631) {
        expectRefused(write("cut.tif", bytes.substr(0, length)), {"cut.tif"});
    }
}

TEST_F(ImageStack, RefusesPagesThatGoRound) {
    const HandMadeTiff tiff{4, 4, 8, false, std::string(16, '\7')};
    std::string bytes = tiff.bytes();
    EXPECT_NO_THROW(openArray(write("once.tif", bytes)));
    // The last four bytes are where the next directory is; bytes 4 to 8 where the first is.
    bytes.replace(bytes.size() - 4, 4, bytes.substr(4, 4));
    expectRefused(write("round.tif", bytes), {"round.tif", "page 0", "comes again"});
}

TEST_F(ImageStack, RefusesPngsWhosePartsAreNotThere) {
    writeTestImage<std::uint8_t>(mFolder / "whole.png", {.width = 60, .height = 60}, 1,
                                 [](int x, int y, int, int) { return x * y; });
    std::ifstream whole(mFolder / "whole.png", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
    // Behind the signature and the header there is room for another part.
    const std::string signature = bytes.substr(0, 33), rest = bytes.substr(33);
    std::string huge(
        "\x7f\xff\xff\xff"
        "juNk");
    huge += std::string(9, '\0');
    expectRefused(write("huge.png", signature + huge + rest), {"huge.png", "juNk", "2147483647"});
    // A name says nothing.
    expectRefused(write("huge.tif", signature + huge + rest), {"huge.tif", "juNk"});
    EXPECT_NO_THROW(openArray(write("more.png", bytes + "what follows")));
    for (std::size_t length = 8; length < bytes.size(); length += 7) {
        expectRefused(write("cut.png", bytes.substr(0, length)), {"cut.png", "cut short"});
    }
}

TEST_F(ImageStack, TakesWhatIsPackedClosely) {
    constexpr int kSide = 1500;
    const auto zero = [](int, int, int, int) { return 0; };
    for (const std::string name : {"none.tif", "zip.tif", "lzw.tif", "packbits.tif", "a.png"}) {
        for (const bool isWide : {false, true}) {
            SCOPED_TRACE(name + (isWide ? ", 16 bits" : ", 8 bits"));
            TestImage image{.width = kSide, .height = kSide};
            if (name.ends_with(".tif")) {
                image.texts = {{"compression", name.substr(0, name.size() - 4)}};
            }
            if (isWide) {
                image.type = OIIO::TypeDesc::UINT16;
                writeTestImage<std::uint16_t>(mFolder / name, image, 1, zero);
            } else {
                writeTestImage<std::uint8_t>(mFolder / name, image, 1, zero);
            }
            EXPECT_EQ(readAll(*openArray(mFolder / name)),
                      std::vector<float>(std::size_t(kSide) * kSide, 0));
        }
    }
}

TEST_F(ImageStack, TellsInputs) {
    for (const char* name : {"a.tif", "a.TIFF", "a.png", "a.exr", "s.###.jpg", "a.npy", "a.dcm"}) {
        EXPECT_TRUE(isArrayInput(name)) << name;
    }
    for (const char* name : {"a.obj", "a.vdb", "a.###.obj", "none", "shape:torus"}) {
        EXPECT_FALSE(isArrayInput(name)) << name;
    }
    EXPECT_TRUE(isArrayInput(mFolder));
}

}  // namespace
}  // namespace bandvox

#include "stack_images.h"

#include <bandvox/core/error.h>
#include <bandvox/source/array_source.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace bandvox {
namespace {

using namespace std::string_literals;

/// Bytes of a number of 32 bits.
std::string little(std::uint32_t number) {
    std::string text;
    for (unsigned shift = 0; shift < 32; shift += 8) text += static_cast<char>(number >> shift);
    return text;
}

class ExrIntegrity : public StackFolder {
  protected:
    /// A file of that packing that holds zeros.
    std::string made(const std::string& packing, int side, int tile = 0) {
        const std::filesystem::path path = mFolder / "made.exr";
        writeTestImage<float>(path,
                              {.width = side,
                               .height = side,
                               .type = OIIO::TypeDesc::FLOAT,
                               .texts = {{"compression", packing}},
                               .tile = tile},
                              1, [](int, int, int, int) { return 0.0F; });
        std::ifstream stream(path, std::ios::binary);
        std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        stream.close();
        std::filesystem::remove(path);
        return bytes;
    }

    void expectRefused(const std::string& bytes, const std::string& why) {
        // The libraries go by what a file begins with, not by its name.
        for (const char* name : {"a.exr", "a.png"}) {
            try {
                openArray(write(name, bytes));
                FAIL() << name << " was opened; expected: " << why;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::Input);
                EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
            }
        }
    }
};

/// The same bytes with others behind `mark`, so far behind it.
std::string changed(std::string bytes, const std::string& mark, std::size_t behind,
                    const std::string& to) {
    const std::size_t found = bytes.find(mark);
    EXPECT_NE(found, std::string::npos) << mark;
    const std::size_t place = found + mark.size() + behind;
    bytes.resize(std::max(bytes.size(), place + to.size()));
    std::copy(to.begin(), to.end(), bytes.begin() + static_cast<std::ptrdiff_t>(place));
    return bytes;
}

TEST_F(ExrIntegrity, TakesAllThatIsWhole) {
    for (const char* packing :
         {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
        for (const int tile : {0, 16, 64}) {
            for (const int side : {1, 40, 700}) {
                SCOPED_TRACE(testing::Message() << packing << " " << tile << " " << side);
                const auto source = openArray(write("a.exr", made(packing, side, tile)));
                std::vector<float> values(static_cast<std::size_t>(side) * side, 1);
                source->readSlices(values);
                EXPECT_EQ(values, std::vector<float>(values.size(), 0));
            }
        }
    }
}

TEST_F(ExrIntegrity, RefusesWhatIsNotInTheFile) {
    const std::string whole = made("zip", 20);
    const std::string channels = "channels\0chlist\0"s, window = "dataWindow\0box2i\0"s;
    // Behind the size of all channels stands the name of the first.
    expectRefused(changed(whole, channels, 6, little(3)), "channel of type 3");
    expectRefused(changed(whole, channels, 0, little(1 << 30)), "of 'channels'");
    expectRefused(changed(whole, channels, 0, little(18)), "'channels'");
    expectRefused(changed(whole, channels, 14, little(0)), "without samples");
    expectRefused(changed(whole, window, 0, little(20)), "expected 16");
    expectRefused(changed(whole, window, 12, little(0x40000000)), "cannot hold");
    expectRefused(changed(whole, window, 16, little(0x40000000)), "cannot hold");
    expectRefused(changed(whole, window, 12, little(-1)), "no pixels");
    expectRefused(changed(whole, "compression\0compression\0"s, 4, "\77"), "compression 63");
    expectRefused(changed(whole, "lineOrder"s, 0, std::string(300, 'x')), "more than 255");
    for (std::size_t length = 8; length < whole.find(window); length += 3) {
        expectRefused(whole.substr(0, length), "its header");
    }
    std::string deep = whole;
    deep[5] = '\10';
    expectRefused(deep, "several samples");
}

TEST_F(ExrIntegrity, RefusesTilesThatAreNotInTheFile) {
    const std::string whole = made("zip", 20, 16);
    const std::string tiles = "tiles\0tiledesc\0"s;
    expectRefused(changed(whole, tiles, 4, little(1 << 20) + little(1 << 20)), "cannot hold");
    expectRefused(changed(whole, "dataWindow\0box2i\0"s, 12, little(4000000)), "cannot hold");
}

}  // namespace
}  // namespace bandvox

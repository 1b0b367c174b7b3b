#include "grid/byte_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <istream>
#include <random>
#include <string>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

// More than a buffer keeps in memory at a time.
std::string manyBytes() {
    std::mt19937 random(11);
    std::string bytes(3'500'001, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    return bytes;
}

// What a stream over bytes [begin, end) says at random places, by reads of random lengths, and by
// moves from wherever it is.
void expectSameAsBytes(const ByteSource& source, const std::string& bytes, std::streamoff begin,
                       std::streamoff end) {
    SourceBuffer buffer(source, begin, end);
    std::istream stream(&buffer);
    std::mt19937 random(3);
    std::streamoff at = 0;
    std::string part;
    for (int i = 0; i < 300; ++i) {
        const std::streamoff to = static_cast<std::streamoff>(random() % (end - begin + 1));
        switch (i % 4) {
            case 0:
                stream.seekg(to);
                break;
            case 1:
                stream.seekg(to - at, std::ios::cur);
                break;
            case 2:
                stream.seekg(to - (end - begin), std::ios::end);
                break;
            default:
                // Not far, as over a chunk of voxels.
                stream.seekg(std::min<std::streamoff>(at + 500, end - begin));
        }
        ASSERT_TRUE(stream) << i;
        at = stream.tellg();
        if (i % 4 != 3) {
            ASSERT_EQ(at, to);
        }
        const auto count =
            static_cast<std::size_t>(i % 7 == 0 ? random() % 2'000'000 : random() % 300);
        part.resize(count);
        stream.read(part.data(), static_cast<std::streamsize>(count));
        const auto expected = std::min(count, static_cast<std::size_t>(end - begin - at));
        ASSERT_EQ(static_cast<std::size_t>(stream.gcount()), expected);
        ASSERT_EQ(part.compare(0, expected, bytes, static_cast<std::size_t>(begin + at), expected),
                  0);
        ASSERT_EQ(static_cast<bool>(stream), expected == count);
        stream.clear();
        at = stream.tellg();
    }
    stream.seekg(end - begin + 1);
    EXPECT_FALSE(stream) << "beyond the end";
    stream.clear();
    stream.seekg(-1, std::ios::beg);
    EXPECT_FALSE(stream) << "before the beginning";
}

TEST(ByteSource, ReadsMemoryFromAnyPlace) {
    const std::string bytes = manyBytes();
    const MemoryBytes source(bytes);
    const auto size = static_cast<std::streamoff>(bytes.size());
    EXPECT_EQ(source.size(), size);
    expectSameAsBytes(source, bytes, 0, size);
    expectSameAsBytes(source, bytes, 1'000'001, 3'000'000);
    expectSameAsBytes(source, bytes, size - 10, size);
    char byte = 0;
    EXPECT_EQ(source.read(size, {&byte, 1}), 0U);
    EXPECT_EQ(source.read(-1, {&byte, 1}), 0U);
}

TEST(ByteSource, ReadsAFileFromAnyPlaceAndEndsWhereItEnds) {
    const fs::path path = fs::temp_directory_path() / ("bandvox-bytes-" + std::to_string(getpid()));
    const std::string bytes = manyBytes();
    std::ofstream(path, std::ios::binary) << bytes;
    const auto size = static_cast<std::streamoff>(bytes.size());
    const FileBytes source(path, size);
    ASSERT_TRUE(source.isOpen());
    expectSameAsBytes(source, bytes, 0, size);
    expectSameAsBytes(source, bytes, 777, 2'500'000);

    fs::resize_file(path, 100);
    std::string part(200, '\0');
    EXPECT_EQ(source.read(0, part), 100U);
    EXPECT_EQ(source.read(100, part), 0U);
    fs::remove(path);
    EXPECT_FALSE(FileBytes(path, 1).isOpen());
}

}  // namespace
}  // namespace bandvox

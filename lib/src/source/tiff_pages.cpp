#include "source/tiff_pages.h"

#include "source/array_header.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <unordered_set>

// "TIFF, Revision 6.0", Adobe 1992, section 2; with offsets of 8 bytes, "The BigTIFF File Format".
namespace bandvox {

namespace {

constexpr int kMostDirectories = 1 << 20;

class TiffBytes {
  public:
    explicit TiffBytes(const std::filesystem::path& path) : mStream(path, std::ios::binary) {}

    // The number of so many bytes at a place; nothing beyond the end.
    std::optional<std::uint64_t> number(std::uint64_t place, int size) {
        std::array<char, 8> bytes{};
        mStream.clear();
        if (place > kFarthest || !mStream.seekg(static_cast<std::streamoff>(place)) ||
            !mStream.read(bytes.data(), size)) {
            return std::nullopt;
        }
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) {
            const int from = mBigEndian ? i : size - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(from)]);
        }
        return value;
    }

    void setBigEndian(bool bigEndian) { mBigEndian = bigEndian; }

  private:
    static constexpr std::uint64_t kFarthest = std::uint64_t(1) << 62;

    std::ifstream mStream;
    bool mBigEndian = false;
};

}  // namespace

std::optional<int> countTiffPages(const std::filesystem::path& path) {
    constexpr std::uint64_t kLittleMark = 0x4949, kBigMark = 0x4d4d;
    constexpr std::uint64_t kClassic = 42, kBigTiff = 43;
    TiffBytes bytes(path);
    const auto order = bytes.number(0, 2);
    if (order != kLittleMark && order != kBigMark) return std::nullopt;
    bytes.setBigEndian(order == kBigMark);
    const auto version = bytes.number(2, 2);
    if (version != kClassic && version != kBigTiff) return std::nullopt;
    const bool isBig = version == kBigTiff;
    const int offsetBytes = isBig ? 8 : 4, countBytes = isBig ? 8 : 2;
    const std::uint64_t entryBytes = isBig ? 20 : 12;

    auto place = bytes.number(isBig ? 8 : 4, offsetBytes);
    int pages = 0;
    std::unordered_set<std::uint64_t> places;
    while (place && *place != 0 && pages < kMostDirectories) {
        if (!places.insert(*place).second) {
            failArray(path, "it is damaged: behind page " + std::to_string(pages - 1) +
                                " an earlier one comes again");
        }
        const auto entries = bytes.number(*place, countBytes);
        constexpr std::uint64_t kMostEntries = 1 << 16;
        place = entries && *entries <= kMostEntries
                    ? bytes.number(
                          *place + static_cast<std::uint64_t>(countBytes) + *entries * entryBytes,
                          offsetBytes)
                    : std::nullopt;
        if (place) ++pages;
    }
    if (!place) {
        failArray(path, "it is cut short or damaged: what describes page " + std::to_string(pages) +
                            " is not in it");
    }
    if (*place != 0) failArray(path, "it has more than 2^20 pages; expected fewer");
    return pages;
}

}  // namespace bandvox

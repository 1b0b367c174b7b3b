#include "stored_pixels.h"

#include "exr_integrity.h"
#include "png_integrity.h"

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

namespace bandvox {

namespace {

// No image is packed more closely.
constexpr double kMostPackedImage = 65536;

// How many bytes each way of packing makes of one at most: zlib repeats 258 bytes by 2 bits, LZW
// makes up to 4096 bytes of 12 bits, and so on.
double mostPackedBy(std::string_view way) {
    if (way == "none") return 1;
    if (way == "rle" || way == "packbits") return 128;
    if (way == "zip" || way == "zips") return 1100;
    if (way == "lzw") return 3000;
    return kMostPackedImage;
}

}  // namespace

void requireSoundImage(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (isExr(stream)) requireSoundExr(stream, lengthOf(path));
    if (isPng(stream)) requireSoundPng(stream, lengthOf(path));
}

void requireSoundImage(std::span<const std::byte> bytes) {
    constexpr std::size_t kStart = 8;
    const auto* const text = reinterpret_cast<const char*>(bytes.data());
    std::istringstream start(std::string(text, std::min(bytes.size(), kStart)));
    const bool exr = isExr(start), png = isPng(start);
    if (!exr && !png) return;
    std::istringstream whole(std::string(text, bytes.size()));
    exr ? requireSoundExr(whole, double(bytes.size()))
        : requireSoundPng(whole, double(bytes.size()));
}

double lengthOf(const std::filesystem::path& path) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    return error ? 0 : static_cast<double>(bytes);
}

double mostPacked(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
    const std::string_view format = input.format_name();
    // Pixels may share samples of colour, 4 x 4 of them, and bytes may be one bit in the file: each
    // or, as numbers of a table of colours, three.
    constexpr double kWidened = 24;
    const int wide = static_cast<int>(8 * spec.format.size());
    const int bits = std::clamp(spec.get_int_attribute("oiio:BitsPerSample", wide), 1, wide);
    const double widened = spec.nchannels == 1 && wide > 8 ? double(wide) / bits : kWidened;
    double packed = kMostPackedImage;
    if (format == "png") packed = mostPackedBy("zip");
    if (format == "tiff" || format == "openexr") {
        packed = mostPackedBy(std::string(spec.get_string_attribute("compression", "unknown")));
    }
    // Tiles are whole in all files but these.
    const double inTiles = double(std::max(spec.tile_width, spec.width)) *
                           double(std::max(spec.tile_height, spec.height)) /
                           (double(spec.width) * double(spec.height));
    return std::min(packed * widened * (format == "openexr" ? inTiles : 1), kMostPackedImage);
}

int rowsTogether(const OIIO::ImageSpec& spec) {
    constexpr int kRows = 256;
    int step = std::max(spec.get_int_attribute("tiff:RowsPerStrip", 1), 1);
    if (spec.tile_width > 0) step = std::max(spec.tile_height, 1);
    if (step >= spec.height) return spec.height;
    return (kRows + step - 1) / step * step;
}

}  // namespace bandvox

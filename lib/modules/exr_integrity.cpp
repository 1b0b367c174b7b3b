// The layout is that of "OpenEXR File Layout", Academy Software Foundation.
#include "exr_integrity.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

namespace {

constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kPartsFlag = 0x1000;
constexpr double kBytesPerChunk = 8;    // in the table of places
constexpr double kAnyChunk = 64 << 20;  // bytes of pixels together that are no matter
constexpr std::size_t kLongestName = 255;

[[noreturn]] void failExr(const std::string& what) {
    throw Error(ErrorKind::Input, "its header " + what);
}

// Types of attributes that always have the same size.
std::optional<std::int64_t> sizeOfType(std::string_view type) {
    struct Entry {
        std::string_view type;
        std::int64_t bytes;
    };
    static constexpr std::array kTypes{
        Entry{"box2i", 16},   Entry{"box2f", 16}, Entry{"chromaticities", 32},
        Entry{"double", 8},   Entry{"float", 4},  Entry{"compression", 1},
        Entry{"envmap", 1},   Entry{"int", 4},    Entry{"deepImageState", 1},
        Entry{"keycode", 28}, Entry{"m33f", 36},  Entry{"lineOrder", 1},
        Entry{"m33d", 72},    Entry{"m44f", 64},  Entry{"m44d", 128},
        Entry{"rational", 8}, Entry{"v2i", 8},    Entry{"tiledesc", 9},
        Entry{"timecode", 8}, Entry{"v2f", 8},    Entry{"v2d", 16},
        Entry{"v3i", 12},     Entry{"v3f", 12},   Entry{"v3d", 24}};
    const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                           [&](const Entry& entry) { return entry.type == type; });
    return found == kTypes.end() ? std::nullopt : std::optional(found->bytes);
}

// Lines that are packed together, and how many bytes one byte of them becomes at most.
struct Packing {
    double lines, most;
};

Packing packingOf(unsigned compression) {
    constexpr double kZip = 1100, kAny = 65536;
    static constexpr std::array kPackings{
        Packing{1, 1},     Packing{1, 128},       Packing{1, kZip}, Packing{16, kZip},
        Packing{32, kAny}, Packing{16, 2 * kZip}, Packing{32, 16},  Packing{32, 16},
        Packing{32, kAny}, Packing{256, kAny}};
    if (compression >= kPackings.size()) {
        failExr("tells of compression " + std::to_string(compression) + "; expected 0 to 9");
    }
    return kPackings[compression];
}

// The value of an attribute, or what stands before it.
class ExrBytes {
  public:
    ExrBytes(std::istream& stream, double length)
        : mStream(stream), mLeft(static_cast<std::int64_t>(length)) {}

    std::int64_t left() const { return mLeft; }

    unsigned char byte() {
        const int c = mStream.get();
        if (c < 0 || mLeft <= 0) failExr("is cut short");
        --mLeft;
        return static_cast<unsigned char>(c);
    }

    std::uint32_t number() {
        std::uint32_t value = 0;
        for (unsigned shift = 0; shift < 32; shift += 8) value |= std::uint32_t(byte()) << shift;
        return value;
    }

    std::int32_t whole() { return static_cast<std::int32_t>(number()); }

    std::string name() {
        std::string text;
        while (const unsigned char c = byte()) {
            text += static_cast<char>(c);
            if (text.size() > kLongestName) failExr("has a name of more than 255 letters");
        }
        return text;
    }

    void skip(std::int64_t bytes) {
        mStream.seekg(bytes, std::ios::cur);
        mLeft -= bytes;
    }

  private:
    std::istream& mStream;
    std::int64_t mLeft;
};

// What a part says of its pixels.
struct ExrPart {
    std::array<double, 4> window{0, 0, -1, -1};  // of x and y the first, then the last
    double bytesPerPixel = 0;
    unsigned compression = 0;
    std::array<double, 2> tile{};  // none: 0
};

void readChannels(ExrBytes& bytes, ExrPart& part) {
    constexpr std::array<double, 3> kBytes{4, 2, 4};  // of whole numbers, half, and float
    for (std::string name = bytes.name(); !name.empty(); name = bytes.name()) {
        const std::uint32_t type = bytes.number();
        if (type >= kBytes.size()) {
            failExr("has a channel of type " + std::to_string(type) + "; expected 0, 1 or 2");
        }
        bytes.number();  // does the eye see it in steps, and nothing
        const double across = bytes.whole(), down = bytes.whole();
        if (across < 1 || down < 1) failExr("has a channel without samples");
        part.bytesPerPixel += kBytes[type] / (across * down);
    }
}

void readTexts(ExrBytes& bytes, std::int64_t end) {
    while (bytes.left() > end) {
        const std::int64_t length = bytes.whole();
        if (length < 0 || length > bytes.left() - end) failExr("has texts that end beyond it");
        bytes.skip(length);
    }
}

void readPreview(ExrBytes& bytes, std::int64_t size) {
    const double width = bytes.number(), height = bytes.number();
    if (width * height * 4 != static_cast<double>(size - 8)) {
        failExr("has a preview that is not as large as it says");
    }
}

// Takes what is followed of a value; `end` is what is left of the file behind it.
void readValue(ExrBytes& bytes, const std::string& name, const std::string& type, std::int64_t size,
               ExrPart& part) {
    const std::int64_t end = bytes.left() - size;
    if (type == "chlist") {
        readChannels(bytes, part);
    } else if (type == "stringvector") {
        readTexts(bytes, end);
    } else if (type == "preview" && size >= 8) {
        readPreview(bytes, size);
    } else if (type == "idmanifest" && size >= 4) {
        if (bytes.number() > 1100.0 * double(size)) failExr("has names that cannot be unpacked");
    } else if (name == "dataWindow" && type == "box2i") {
        for (double& corner : part.window) corner = bytes.whole();
    } else if (name == "compression" && type == "compression") {
        part.compression = bytes.byte();
    } else if (name == "tiles" && type == "tiledesc") {
        for (double& side : part.tile) side = bytes.number();
    }
    if (bytes.left() < end) failExr("has an attribute '" + name + "' that is longer than it says");
    const bool isWhole = type == "chlist" || type == "stringvector";
    if (isWhole && bytes.left() > end) {
        failExr("has an attribute '" + name + "' that is shorter than it says");
    }
    bytes.skip(bytes.left() - end);
}

// Reads a header; false if there is none, as behind the last.
bool readHeader(ExrBytes& bytes, ExrPart& part) {
    bool isFirst = true;
    for (std::string name = bytes.name(); !name.empty(); name = bytes.name()) {
        isFirst = false;
        const std::string type = bytes.name();
        const std::int64_t size = bytes.whole();
        if (size < 0 || size > bytes.left()) {
            failExr("tells of " + std::to_string(size) + " bytes of '" + name + "'; it has " +
                    std::to_string(bytes.left()) + " more");
        }
        const auto expected = sizeOfType(type);
        if (expected && *expected != size) {
            failExr("tells of " + std::to_string(size) + " bytes of '" + name + "'; expected " +
                    std::to_string(*expected));
        }
        readValue(bytes, name, type, size, part);
    }
    return !isFirst;
}

// Of a part: can its pixels be in a file of so many bytes, of which so many are left?
void requirePlausible(const ExrPart& part, double length, double left) {
    const double width = part.window[2] - part.window[0] + 1;
    const double height = part.window[3] - part.window[1] + 1;
    if (width < 1 || height < 1) failExr("tells of no pixels");
    const Packing packing = packingOf(part.compression);
    const bool isTiled = part.tile[0] > 0 && part.tile[1] > 0;
    const double across = isTiled ? part.tile[0] : width;
    const double down = isTiled ? part.tile[1] : packing.lines;
    const double chunks = std::ceil(width / across) * std::ceil(height / down);
    const double pixels = width * height * part.bytesPerPixel;
    const double most = packing.most * length;
    if (chunks * kBytesPerChunk <= left && pixels <= most &&
        across * down * part.bytesPerPixel <= std::max(pixels, kAnyChunk)) {
        return;
    }
    std::string size = std::to_string(static_cast<long long>(width)) + " x ";
    size += std::to_string(static_cast<long long>(height));
    failExr("tells of " + size + " pixels; its " + std::to_string(static_cast<long long>(length)) +
            " bytes cannot hold them");
}

}  // namespace

bool isExr(std::istream& stream) {
    std::array<unsigned char, 4> magic{};
    stream.read(reinterpret_cast<char*>(magic.data()), magic.size());
    const bool isWhole = static_cast<bool>(stream);
    stream.clear();
    stream.seekg(0);
    return isWhole && magic == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
}

void requireSoundExr(std::istream& stream, double length) {
    ExrBytes bytes(stream, length);
    bytes.number();
    const std::uint32_t version = bytes.number();
    if ((version & kDeepFlag) != 0) {
        failExr("tells of several samples to a pixel; expected flat images");
    }
    const bool isOfParts = (version & kPartsFlag) != 0;
    std::vector<ExrPart> parts;
    while (true) {
        ExrPart part;
        if (!readHeader(bytes, part)) break;
        if ((version & kTiledFlag) == 0 && !isOfParts) part.tile = {};
        parts.push_back(part);
        if (!isOfParts) break;
    }
    if (parts.empty()) failExr("is empty");
    for (const ExrPart& part : parts) {
        requirePlausible(part, length, static_cast<double>(bytes.left()));
    }
}

}  // namespace bandvox

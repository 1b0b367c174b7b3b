#include "core/words.h"
#include "source/array_header.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

// numpy.lib.format: "\x93NUMPY", two bytes of version, the length of the header, and a Python
// dictionary of descr, fortran_order and shape.
namespace bandvox {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kLongestHeader = 1 << 16;

// What follows 'key': in the dictionary.
std::string_view valueOf(const std::filesystem::path& path, std::string_view text,
                         std::string_view key) {
    for (const char quote : {'\'', '"'}) {
        const std::string quoted = quote + std::string(key) + quote;
        std::size_t at = text.find(quoted);
        if (at == std::string_view::npos) continue;
        at = text.find_first_not_of(" :", at + quoted.size());
        if (at != std::string_view::npos) return text.substr(at);
    }
    failArray(path, "its header has no '" + std::string(key) + "'");
}

std::optional<ArrayType> typeOf(std::string_view code) {
    struct Entry {
        std::string_view code;
        ArrayType type;
    };
    static constexpr std::array kCodes{
        Entry{"b1", ArrayType::Bool},   Entry{"i1", ArrayType::Int8},
        Entry{"u1", ArrayType::UInt8},  Entry{"i2", ArrayType::Int16},
        Entry{"u2", ArrayType::UInt16}, Entry{"i4", ArrayType::Int32},
        Entry{"u4", ArrayType::UInt32}, Entry{"i8", ArrayType::Int64},
        Entry{"u8", ArrayType::UInt64}, Entry{"f2", ArrayType::Half},
        Entry{"f4", ArrayType::Float},  Entry{"f8", ArrayType::Double}};
    for (const Entry& entry : kCodes) {
        if (entry.code == code) return entry.type;
    }
    return std::nullopt;
}

std::string readDictionary(const std::filesystem::path& path, std::istream& stream) {
    std::array<char, 8> start{};
    stream.read(start.data(), start.size());
    if (!stream || std::string_view(start.data(), kMagic.size()) != kMagic) {
        failArray(path, "it is no .npy file: it does not begin with \\x93NUMPY");
    }
    const int version = static_cast<unsigned char>(start[6]);
    if (version < 1 || version > 3) {
        failArray(path,
                  "it is of version " + std::to_string(version) + " of .npy; expected 1 to 3");
    }
    std::array<unsigned char, 4> bytes{};
    stream.read(reinterpret_cast<char*>(bytes.data()), version == 1 ? 2 : 4);
    std::size_t length = 0;
    for (int i = 3; i >= 0; --i) length = length << 8 | bytes[i];
    if (!stream || length > kLongestHeader) failArray(path, "its header is cut short or damaged");
    std::string text(length, '\0');
    if (!stream.read(text.data(), static_cast<std::streamsize>(length))) {
        failArray(path, "it ends in its header");
    }
    return text;
}

}  // namespace

NpyLayout readNpyLayout(const std::filesystem::path& path, std::istream& stream,
                        std::size_t dimensions) {
    const std::string text = readDictionary(path, stream);
    const std::string_view descr = valueOf(path, text, "descr");
    // Quote, byte order, type.
    const std::string code(descr.substr(0, descr.find_first_of(",}", 1)));
    const std::optional<ArrayType> type =
        code.size() >= 4 ? typeOf(std::string_view(code).substr(2, 2)) : std::nullopt;
    const bool isPlain = code.size() >= 5 && (code[4] == '\'' || code[4] == '"') &&
                         std::string_view("<>|=").find(code[1]) != std::string_view::npos;
    if (!type || !isPlain) {
        failArray(path, "its values are of type " + code.substr(0, 40) +
                            "; expected bool, whole numbers or floats of 1 to 8 bytes");
    }
    NpyLayout layout;
    layout.type = *type;
    layout.bigEndian = code[1] == '>';
    layout.isFortran = valueOf(path, text, "fortran_order").starts_with("True");
    std::string_view shape = valueOf(path, text, "shape");
    const std::size_t close = shape.find(')');
    if (!shape.starts_with('(') || close == std::string_view::npos) {
        failArray(path, "its header has no shape");
    }
    layout.sizes = numbersIn(path, shape.substr(0, close + 1), dimensions, "sizes");
    for (const double size : layout.sizes) {
        if (size >= 0 && size == std::floor(size)) continue;
        failArray(path, "it has the size " + inShort(size) + "; expected whole numbers");
    }
    return layout;
}

ArrayHeader readNpyHeader(const std::filesystem::path& path, std::istream& stream) {
    const NpyLayout layout = readNpyLayout(path, stream, 3);
    ArrayHeader header;
    header.type = layout.type;
    header.bigEndian = layout.bigEndian;
    header.info.size = arraySize(path, layout.sizes);
    header.info.axes = layout.isFortran ? std::array{0, 1, 2} : std::array{2, 1, 0};
    header.info.toWorld = openvdb::Mat4d::identity();
    header.files = {path};
    header.skipBytes = stream.tellg();
    return header;
}

}  // namespace bandvox

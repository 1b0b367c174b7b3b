#include "source/read_texture.h"

#include "core/image_library.h"
#include "source/srgb.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

constexpr int kLargestTexture = 1 << 16;  // texels along a side

/// Linear light of each of the 65536 values of a channel that is coded in sRGB.
const std::vector<std::uint16_t>& linearTable() {
    static const std::vector<std::uint16_t> table = [] {
        std::vector<std::uint16_t> values;
        for (int i = 0; i <= 65535; ++i) {
            values.push_back(static_cast<std::uint16_t>(
                std::lround(65535 * linearOfSrgb(static_cast<double>(i) / 65535))));
        }
        return values;
    }();
    return table;
}

/// Three channels of one, in place from the back.
void repeatGrey(std::vector<std::uint16_t>& values) {
    const std::size_t texels = values.size();
    values.resize(3 * texels);
    for (std::size_t i = texels; i-- > 0;) {
        const std::uint16_t grey = values[i];
        values[3 * i] = values[3 * i + 1] = values[3 * i + 2] = grey;
    }
}

[[noreturn]] void failPicture(const std::string& why) {
    throw Error(ErrorKind::Input, why);
}

void requireSize(int width, int height, double bytes) {
    if (width > kLargestTexture || height > kLargestTexture) {
        failPicture("has " + std::to_string(width) + " x " + std::to_string(height) +
                    " texels; expected up to " + std::to_string(kLargestTexture) +
                    " along each side");
    }
    requireMemory(
        Texture::memory(width, height) + bytes,
        ("a texture of " + std::to_string(width) + " x " + std::to_string(height) + " texels")
            .c_str());
}

std::shared_ptr<const Texture> makeTexture(CodedPixels picture) {
    if (picture.channels == 1) repeatGrey(picture.values);
    if (!picture.isLinear) {
        for (std::uint16_t& value : picture.values) value = linearTable()[value];
    }
    return std::make_shared<Texture>(picture.width, picture.height, std::move(picture.values));
}

/// The kind that a file is by its first bytes, or `said`, which is often wrong or empty.
std::string kindOf(std::span<const std::byte> bytes, const std::string& said) {
    const auto starts = [&](std::string_view magic) {
        return bytes.size() >= magic.size() &&
               std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    if (starts("\x89PNG")) return "png";
    if (starts("\xFF\xD8")) return "jpg";
    return said;
}

}  // namespace

std::shared_ptr<const Texture> readTexture(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) failPicture("does not exist");
    if (!std::filesystem::is_regular_file(path, ignored)) failPicture("is not a regular file");
    return makeTexture(imageLibrary().readCoded(path, requireSize));
}

std::shared_ptr<const Texture> readTexture(std::span<const std::byte> bytes,
                                           const std::string& kind) {
    return makeTexture(
        imageLibrary().readCoded(bytes, "texture." + kindOf(bytes, kind), requireSize));
}

}  // namespace bandvox

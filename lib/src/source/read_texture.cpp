#include "source/read_texture.h"

#include "source/srgb.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

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

/// Colours that are multiplied with alpha would be darker than they are.
OIIO::ImageSpec unmultiplied() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

std::shared_ptr<const Texture> readPicture(OIIO::ImageInput* input) {
    if (input == nullptr) failPicture("cannot be read: " + OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    const bool isFlat = spec.depth <= 1 && !spec.deep && spec.nchannels >= 1;
    if (!isFlat || spec.width < 1 || spec.height < 1 || spec.width > kLargestTexture ||
        spec.height > kLargestTexture) {
        failPicture("has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                    " x " + std::to_string(spec.depth) + " texels of " +
                    std::to_string(spec.nchannels) +
                    " channels; expected a flat picture of up to " +
                    std::to_string(kLargestTexture) + " along each side");
    }
    requireMemory(Texture::memory(spec.width, spec.height) + 2.0 * spec.image_bytes(true),
                  ("a texture of " + std::to_string(spec.width) + " x " +
                   std::to_string(spec.height) + " texels")
                      .c_str());
    const bool isLinear = spec.format.is_floating_point();
    const int channels = spec.nchannels >= 3 ? 3 : 1;
    const int width = spec.width;
    const int height = spec.height;
    std::vector<std::uint16_t> rgb(static_cast<std::size_t>(width) * height * channels);
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT16, rgb.data())) {
        failPicture("cannot be read: " + input->geterror());
    }
    if (channels == 1) repeatGrey(rgb);
    if (!isLinear) {
        for (std::uint16_t& value : rgb) value = linearTable()[value];
    }
    return std::make_shared<Texture>(width, height, std::move(rgb));
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
    const OIIO::ImageSpec config = unmultiplied();
    return readPicture(OIIO::ImageInput::open(path.string(), &config).get());
}

std::shared_ptr<const Texture> readTexture(std::span<const std::byte> bytes,
                                           const std::string& kind) {
    OIIO::ImageSpec config = unmultiplied();
    OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &reader;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    return readPicture(OIIO::ImageInput::open("texture." + kindOf(bytes, kind), &config).get());
}

}  // namespace bandvox

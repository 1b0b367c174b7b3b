#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

// What image files claim and what they hold, which damage makes two things.
namespace bandvox {

/// Checks what OpenImageIO trusts in before it opens an image file, or what one holds. Throws
/// Error(ErrorKind::Input), which does not name the file.
void requireSoundImage(const std::filesystem::path& path);
void requireSoundImage(std::span<const std::byte> bytes);

/// Bytes of a file; 0 if it is none.
double lengthOf(const std::filesystem::path& path);

/// How many bytes of pixels, as OpenImageIO unpacks them, a byte of the file can become at most.
double mostPacked(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec);

/// Of a picture that is read by stretches of rows, their rows: at least 256, and whole strips and
/// tiles of the file.
int rowsTogether(const OIIO::ImageSpec& spec);

/// Reads so many channels of a page as [height][width][channels] values of a type. They take memory
/// as far as the file goes, not as far as it claims. `Value` is that type, or char. False if it
/// cannot be read to its end; the input then has the reason.
template <typename Value>
bool readPixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int page, int firstChannel,
                int channels, OIIO::TypeDesc type, std::vector<Value>& values) {
    const std::size_t perPixel = std::is_same_v<Value, char> ? type.size() : 1;
    const std::size_t perRow = static_cast<std::size_t>(spec.width) * channels * perPixel;
    const int rows = rowsTogether(spec), endChannel = firstChannel + channels;
    values.clear();
    values.reserve(perRow * spec.height);
    for (int top = 0; top < spec.height; top += rows) {
        const int bottom = std::min(top + rows, spec.height);
        values.resize(perRow * bottom);
        Value* const to = values.data() + perRow * top;
        const bool good = spec.tile_width > 0
                              ? input.read_tiles(page, 0, spec.x, spec.x + spec.width, spec.y + top,
                                                 spec.y + bottom, spec.z, spec.z + 1, firstChannel,
                                                 endChannel, type, to)
                              : input.read_scanlines(page, 0, spec.y + top, spec.y + bottom, spec.z,
                                                     firstChannel, endChannel, type, to);
        if (!good) return false;
    }
    return true;
}

}  // namespace bandvox

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

/// Pixels in linear light.
struct PixelArray {
    int width = 0, height = 0;
    int channels = 0;           ///< R, G, B, A in that order, as far as they are there
    std::vector<float> values;  ///< [height][width][channels], rows from the top
};

/// A picture for a .png file.
struct PngRows {
    int width = 0, height = 0;
    std::vector<std::pair<std::string, std::string>> metadata;
    /// Sets `pixels`, [bottom - top][width][4], to rows of linear R G B, not multiplied by the
    /// alpha that follows. Is asked for rows from the top, and may throw.
    std::function<void(int top, int bottom, std::vector<float>& pixels)> rows;
};

/// What went wrong while a file was written.
struct WriteFailure {
    std::string text;   ///< of the encoder; empty if nothing did
    int diskError = 0;  ///< of the stream, as in errno; 0 if nothing did
};

/// Reads and writes image files with OpenImageIO. That library depends on hundreds of others, and
/// loading them takes longer than many a picture, so it lies in a module that is loaded when it is
/// first needed.
class ImageLibrary {
  public:
    virtual ~ImageLibrary() = default;

    /// The first picture in a file. Throws Error(ErrorKind::Input) if it cannot be read.
    virtual PixelArray read(const std::filesystem::path& path) const = 0;

    /// The same from what such a file holds; errors call it `name`, whose extension says what it
    /// is if the bytes do not.
    virtual PixelArray read(std::span<const std::byte> bytes, const std::string& name) const = 0;

    /// Writes 8-bit sRGB with alpha.
    virtual WriteFailure writePng(std::ostream& stream, const PngRows& image) const = 0;
};

/// Throws Error(ErrorKind::Runtime) if the module cannot be loaded.
const ImageLibrary& imageLibrary();

}  // namespace bandvox

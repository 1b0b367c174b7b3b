#pragma once

#include "core/dicom_files.h"
#include "core/slice_files.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
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

/// Pixels as they are coded, 65535 being the largest value.
struct CodedPixels {
    int width = 0, height = 0;
    int channels = 0;                   ///< 1, grey, or 3; alpha is left out, and not multiplied in
    bool isLinear = false;              ///< else sRGB
    std::vector<std::uint16_t> values;  ///< [height][width][channels], rows from the top
};

/// Is asked before the pixels are read, with width, height and the bytes that reading takes; may
/// throw.
using PixelGuard = std::function<void(int width, int height, double bytes)>;

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

/// Reads and writes image files with OpenImageIO and DCMTK. These libraries depend on hundreds of
/// others, and loading them takes longer than many a picture, so it lies in a module that is loaded
/// when it is first needed.
class ImageLibrary {
  public:
    virtual ~ImageLibrary() = default;

    /// The first picture in a file. Throws Error(ErrorKind::Input) if it cannot be read.
    virtual PixelArray read(const std::filesystem::path& path) const = 0;

    /// The same from what such a file holds; errors call it `name`, whose extension says what it
    /// is if the bytes do not.
    virtual PixelArray read(std::span<const std::byte> bytes, const std::string& name) const = 0;

    /// The same as it is coded. Throws Error(ErrorKind::Input), which does not name the file.
    virtual CodedPixels readCoded(const std::filesystem::path& path,
                                  const PixelGuard& guard) const = 0;
    virtual CodedPixels readCoded(std::span<const std::byte> bytes, const std::string& name,
                                  const PixelGuard& guard) const = 0;

    /// Why the colour configuration of the environment variable OCIO is not used by writePng, with
    /// its name; empty if it is, or if there is none.
    virtual std::string colorFault() const = 0;

    /// Writes 8-bit sRGB with alpha.
    virtual WriteFailure writePng(std::ostream& stream, const PngRows& image) const = 0;

    /// Opens the pages of a file for their values as they are stored, which so many threads may
    /// unpack. Throws
    /// Error(ErrorKind::Input), which does not name the file, if it cannot be read or if its pages
    /// are not alike.
    virtual std::unique_ptr<SliceFile> openSlices(const std::filesystem::path& path,
                                                  int threads) const = 0;

    /// Creates a file for pages, replacing what is there. Throws Error(ErrorKind::Runtime), which
    /// does not name the file.
    virtual std::unique_ptr<SliceOutput> createSlices(const std::filesystem::path& path,
                                                      const SliceOutputInfo& info) const = 0;

    /// Opens a DICOM file. Throws Error(ErrorKind::Input), which does not name the file.
    virtual std::unique_ptr<DicomFile> openDicom(const std::filesystem::path& path) const = 0;
};

/// Throws Error(ErrorKind::Runtime) if the module cannot be loaded.
const ImageLibrary& imageLibrary();

}  // namespace bandvox

#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

/// What a file of images says of them.
struct SliceFileInfo {
    int width = 0, height = 0;
    int pages = 0;                       ///< all alike
    std::vector<std::string> channels;   ///< "Y", "R", "A", ...
    std::string type;                    ///< "uint8", "uint16", "float16", ...
    int bits = 0;                        ///< of a value, before it was widened to `type`
    double pageBytes = 0;                ///< memory that reading a page takes
    double mostPacked = 1;               ///< bytes of a page that a byte of the file can become
    std::string description;             ///< free text; empty if there is none
    std::array<double, 2> resolution{};  ///< pixels per unit along x and y; 0: unknown
};

/// The images of a file, with values as they are stored: nothing is done to colours, alpha is not
/// multiplied in.
class SliceFile {
  public:
    virtual ~SliceFile() = default;

    const SliceFileInfo& info() const { return mInfo; }

    /// Reads channels of a page as [height][width][channels] values of the file's type, in the
    /// machine's byte order. Throws Error(ErrorKind::Input), which does not name the file.
    virtual void read(int page, int firstChannel, int channels, std::vector<char>& values) = 0;

  protected:
    SliceFileInfo mInfo;
};

/// What is written to a file of images with one channel.
struct SliceOutputInfo {
    int width = 0, height = 0;
    std::string type;                    ///< one of those of SliceFileInfo
    std::string extension;               ///< of the format, with the dot
    bool compress = true;                ///< without loss
    bool large = false;                  ///< there will be more than a TIFF file commonly holds
    std::string description;             ///< free text
    std::array<double, 2> resolution{};  ///< pixels per unit along x and y; 0: not said
    int threads = 1;                     ///< that may pack parts of a page
};

/// A file that images are written to, one after another. Throws Error(ErrorKind::Runtime), which
/// does not name the file.
class SliceOutput {
  public:
    virtual ~SliceOutput() = default;

    /// Writes the next page, [height][width] values in the machine's byte order.
    virtual void write(const char* values) = 0;

    /// Writes what is left.
    virtual void close() = 0;
};

}  // namespace bandvox

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// What a DICOM file says of one of its frames.
struct DicomFrame {
    std::optional<std::array<double, 3>> position;     ///< centre of the first pixel, mm
    std::optional<std::array<double, 6>> orientation;  ///< of a row, then of a column
    std::optional<std::array<double, 2>> spacing;      ///< of rows, then of columns, mm
    double slope = 1, intercept = 0;                   ///< value = slope · stored + intercept
};

/// What a DICOM file says of the images in it.
struct DicomInfo {
    std::string series;       ///< SeriesInstanceUID
    std::string description;  ///< of the series
    std::string modality;     ///< "CT", ...
    std::string photometric;  ///< "MONOCHROME2", ...
    int width = 0, height = 0;
    int bitsAllocated = 0;           ///< 8, 16 or 32
    int bitsStored = 0;              ///< at most that
    int highBit = 0;                 ///< the last one that is used
    bool isSigned = false;           ///< two's complement
    double sliceStep = 0;            ///< mm between slices, or as thick as they are; 0 if not said
    std::vector<DicomFrame> frames;  ///< none if there are no images in it
};

/// The images of a DICOM file.
class DicomFile {
  public:
    virtual ~DicomFile() = default;

    const DicomInfo& info() const { return mInfo; }

    /// Reads a frame as [height][width] numbers of so many bits as are allocated, in the machine's
    /// byte order; unpacked. Throws Error(ErrorKind::Input), which does not name the file.
    virtual void read(int frame, std::vector<char>& values) = 0;

  protected:
    DicomInfo mInfo;
};

}  // namespace bandvox

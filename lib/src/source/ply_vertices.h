#pragma once

#include "source/ply_header.h"

#include <bandvox/core/progress.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bandvox {

/// The rows of the element "vertex" of a .ply file, in text or binary.
class PlyVertices {
  public:
    /// Reads the header; keeps a reference to the file. Throws Error(ErrorKind::Input) if it is
    /// none, there are no vertices, or they have lists.
    explicit PlyVertices(const FileContents& file);

    const PlyHeader& header() const { return mHeader; }
    const std::vector<PlyProperty>& properties() const { return vertex().properties; }
    /// Of the properties.
    std::vector<std::string> names() const;
    std::size_t count() const { return static_cast<std::size_t>(vertex().count); }

    /// Calls take(row, values) for each row, with the values of the properties that are asked for.
    /// Throws Error(ErrorKind::Input) if the file is cut short or has something else than numbers,
    /// Error(ErrorKind::Interrupted).
    using Take = std::function<void(std::size_t row, const std::vector<double>& values)>;
    void read(const std::vector<std::size_t>& columns, const Take& take, Progress& progress);

  private:
    const PlyElement& vertex() const { return mHeader.elements[mIndex]; }
    void passBefore();
    void readText(const std::vector<std::size_t>& columns, const Take& take);
    void readBinary(const std::vector<std::size_t>& columns, const Take& take);
    [[noreturn]] void failShort(std::size_t most) const;

    const FileContents& mFile;
    TextLines mLines;
    PlyHeader mHeader;
    std::size_t mIndex = 0;  // of the vertices among the elements
    std::size_t mBegin = 0;  // of the next number of a binary file
};

}  // namespace bandvox

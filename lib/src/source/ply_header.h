#pragma once

#include "source/text_lines.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// A type of number in a .ply file.
struct PlyType {
    std::size_t bytes = 0;
    bool isSigned = false;
    bool isReal = false;
};

struct PlyProperty {
    std::string name;
    PlyType type;
    bool isList = false;
    PlyType countType;
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding { Text, LittleEndian, BigEndian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Text;
    std::vector<PlyElement> elements;

    /// Null if there is none of the name.
    const PlyElement* find(std::string_view name) const;

    /// True if it says that there are faces or strips of them.
    bool hasFaces() const;
};

/// Reads the header and leaves `lines`, which stand at the file's begin, at its end.
/// Throws Error(ErrorKind::Input).
PlyHeader readPlyHeader(const FileContents& file, TextLines& lines);

}  // namespace bandvox

#include "source/little_endian.h"
#include "source/text_lines.h"

namespace bandvox {
namespace {

constexpr std::size_t kBinaryHeader = 84;
constexpr std::size_t kBinaryFacet = 50;

/// Size that a binary file with this header has.
std::size_t binarySize(const std::string& bytes) {
    return kBinaryHeader + kBinaryFacet * std::size_t(littleEndian32(bytes, 80));
}

void checkText(const FileContents& file) {
    TextLines lines(file);
    bool ended = false;
    std::size_t facets = 0;
    std::size_t corners = 0;
    while (lines.nextWithWords()) {
        const auto& words = lines.words();
        ended = words[0] == "endsolid";
        if (words[0] == "facet") {
            ++facets;
            corners = 0;
        } else if (words[0] == "vertex") {
            if (words.size() < 4) {
                lines.fail("has a corner with " + std::to_string(words.size() - 1) +
                           " coordinates; expected 3");
            }
            for (std::size_t i = 1; i < 4; ++i) lines.coordinate(i);
            ++corners;
        } else if (words[0] == "endfacet" && corners != 3) {
            lines.fail("ends a facet with " + std::to_string(corners) + " corners; expected 3");
        }
    }
    if (!ended) file.fail("is cut short: it does not end with \"endsolid\"");
    if (facets == 0) file.fail("has no facets; expected a surface");
}

}  // namespace

void checkStl(const FileContents& file) {
    const std::string& bytes = file.bytes;
    if (bytes.size() >= kBinaryHeader && binarySize(bytes) == bytes.size()) {
        if (bytes.size() == kBinaryHeader) file.fail("has no facets; expected a surface");
        return;
    }
    // Binary files may begin with "solid" as well, but text does not hold zeros.
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    const bool text = first != std::string::npos && bytes.compare(first, 5, "solid") == 0 &&
                      bytes.find('\0') == std::string::npos;
    if (text) {
        checkText(file);
        return;
    }
    if (bytes.size() < kBinaryHeader) {
        file.fail("has " + std::to_string(bytes.size()) +
                  " bytes; expected \"solid\", or a binary header of 84 bytes");
    }
    file.fail("has " + std::to_string(bytes.size()) +
              " bytes; a binary STL file with its header has " + std::to_string(binarySize(bytes)));
}

}  // namespace bandvox

#include "source/ply_header.h"

#include <algorithm>
#include <array>

namespace bandvox {
namespace {

PlyType readPlyType(std::string_view word, const TextLines& lines) {
    struct Named {
        std::string_view name, otherName;
        PlyType type;
    };
    static constexpr std::array<Named, 8> kTypes = {{{"char", "int8", {1, true, false}},
                                                     {"uchar", "uint8", {1, false, false}},
                                                     {"short", "int16", {2, true, false}},
                                                     {"ushort", "uint16", {2, false, false}},
                                                     {"int", "int32", {4, true, false}},
                                                     {"uint", "uint32", {4, false, false}},
                                                     {"float", "float32", {4, true, true}},
                                                     {"double", "float64", {8, true, true}}}};
    for (const Named& named : kTypes) {
        if (word == named.name || word == named.otherName) return named.type;
    }
    lines.fail("has the type \"" + std::string(word.substr(0, 40)) +
               "\"; expected one of PLY's, such as float or int");
}

PlyProperty readPlyProperty(const TextLines& lines) {
    const auto& words = lines.words();
    const bool isList = words.size() > 1 && words[1] == "list";
    if (words.size() < (isList ? 5u : 3u)) {
        lines.fail("has an incomplete property; expected its type and name");
    }
    PlyProperty property;
    property.isList = isList;
    property.name = words[isList ? 4 : 2];
    property.type = readPlyType(words[isList ? 3 : 1], lines);
    if (isList) {
        property.countType = readPlyType(words[2], lines);
        if (property.countType.isReal) lines.fail("counts a list by a real; expected an integer");
    }
    return property;
}

}  // namespace

const PlyElement* PlyHeader::find(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [name](const PlyElement& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
}

bool PlyHeader::hasFaces() const {
    const PlyElement* face = find("face");
    const PlyElement* strips = find("tristrips");
    return (face != nullptr && face->count > 0) || (strips != nullptr && strips->count > 0);
}

PlyHeader readPlyHeader(const FileContents& file, TextLines& lines) {
    if (!lines.next() || lines.words().size() != 1 || lines.words()[0] != "ply") {
        file.fail("does not begin with \"ply\"");
    }
    PlyHeader header;
    bool hasFormat = false;
    while (true) {
        if (!lines.nextWithWords()) file.fail("is cut short: its header has no \"end_header\"");
        const auto& words = lines.words();
        if (words[0] == "end_header") break;
        if (words[0] == "format") {
            const std::string_view name = words.size() > 1 ? words[1] : "";
            if (name == "binary_little_endian") {
                header.encoding = PlyEncoding::LittleEndian;
            } else if (name == "binary_big_endian") {
                header.encoding = PlyEncoding::BigEndian;
            } else if (name != "ascii") {
                lines.fail(
                    "has an unknown format; expected ascii, binary_little_endian or "
                    "binary_big_endian");
            }
            hasFormat = true;
        } else if (words[0] == "element") {
            if (words.size() < 3) lines.fail("has an incomplete element; expected name and count");
            header.elements.push_back({std::string(words[1]), lines.integer(2), {}});
            if (header.elements.back().count < 0) lines.fail("has a negative count");
        } else if (words[0] == "property") {
            if (header.elements.empty()) lines.fail("has a property before any element");
            header.elements.back().properties.push_back(readPlyProperty(lines));
        }
    }
    if (!hasFormat) file.fail("has no format in its header");
    return header;
}

}  // namespace bandvox

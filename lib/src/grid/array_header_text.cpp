#include "grid/array_header_text.h"

#include <bandvox/core/error.h>
#include <bandvox/source/world_space.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>

namespace bandvox {

namespace {

constexpr bool kIsBig = std::endian::native == std::endian::big;

// The shortest text that reads back as the number.
std::string exactText(double number) {
    char text[32];
    // So that there is no -0.
    const auto end = std::to_chars(text, text + sizeof text, number + 0.0).ptr;
    return {text, end};
}

std::string threeTexts(const openvdb::Vec3d& numbers, const char* between) {
    std::string text = exactText(numbers[0]);
    text += between + exactText(numbers[1]);
    text += between + exactText(numbers[2]);
    return text;
}

std::string sizeText(const openvdb::Coord& size, const char* between) {
    std::string text = std::to_string(size[0]);
    text += between + std::to_string(size[1]);
    text += between + std::to_string(size[2]);
    return text;
}

openvdb::Vec3d rowOf(const openvdb::Mat4d& matrix, int row) {
    return {matrix(row, 0), matrix(row, 1), matrix(row, 2)};
}

using TypeWords = std::array<const char*, 6>;

const char* wordFor(VoxelType type, const TypeWords& words, const char* format) {
    const char* const word = words[static_cast<std::size_t>(type)];
    if (word) return word;
    throw Error(ErrorKind::Usage, std::string(format) + " holds no values of type " +
                                      voxelTypeNames()[static_cast<std::size_t>(type)] +
                                      "; expected another type, or a .npy file");
}

bool isNrrdSpace(const std::string& space) {
    for (const char* known :
         {"right-anterior-superior", "left-anterior-superior", "left-posterior-superior", "RAS",
          "LAS", "LPS", "scanner-xyz", "3D-right-handed", "3D-left-handed"}) {
        if (space == known) return true;
    }
    return false;
}

bool canBeQuoted(const std::string& unit) {
    return !unit.empty() && std::none_of(unit.begin(), unit.end(), [](unsigned char c) {
        return c < ' ' || c == '"' || c == '\\';
    });
}

}  // namespace

std::string npyHeader(const ArrayHeaderRequest& request) {
    static constexpr TypeWords kWords{"|u1", "<u2", "<i2", "<f2", "<f4", "<f8"};
    std::string code = wordFor(request.type, kWords, "a .npy file");
    if (kIsBig && code[0] == '<') code[0] = '>';
    std::string text = "{'descr': '" + code;
    text += "', 'fortran_order': False, 'shape': (" + sizeText(request.size, ", ");
    text += "), }";
    // The values begin at a multiple of 64 bytes.
    constexpr std::size_t kStart = 10, kAlignment = 64;
    while ((kStart + text.size() + 1) % kAlignment != 0) text += ' ';
    text += '\n';
    std::string header = "\x93NUMPY";
    header += '\x01';
    header += '\0';
    header += static_cast<char>(text.size() & 255);
    header += static_cast<char>(text.size() >> 8);
    return header + text;
}

std::string nrrdHeader(const ArrayHeaderRequest& request) {
    static constexpr TypeWords kWords{"uint8", "uint16", "int16", nullptr, "float", "double"};
    std::string text = "NRRD0004\ntype: ";
    text += wordFor(request.type, kWords, "NRRD");
    text += "\ndimension: 3\n";
    const std::string& space = request.place.space;
    text += isNrrdSpace(space) ? "space: " + space : "space dimension: 3";
    if (canBeQuoted(request.place.unit)) {
        text += "\nspace units:";
        for (int axis = 0; axis < 3; ++axis) text += " \"" + request.place.unit + '"';
    }
    text += "\nsizes: " + sizeText(request.size, " ");
    text += "\nspace directions:";
    for (int axis = 0; axis < 3; ++axis) {
        text += " (" + threeTexts(rowOf(request.toWorld, axis), ",");
        text += ')';
    }
    text += "\nkinds: domain domain domain\nendian: ";
    text += kIsBig ? "big" : "little";
    text += "\nencoding: ";
    text += request.compressed ? "gzip" : "raw";
    text += "\nspace origin: (" + threeTexts(rowOf(request.toWorld, 3), ",");
    text += ")\n";
    // An empty line ends a header that values follow.
    if (request.valuesFile.empty()) return text + "\n";
    return text + "data file: " + request.valuesFile + "\n";
}

std::string metaImageHeader(const ArrayHeaderRequest& request) {
    static constexpr TypeWords kWords{"MET_UCHAR", "MET_USHORT", "MET_SHORT",
                                      nullptr,     "MET_FLOAT",  "MET_DOUBLE"};
    std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\n";
    text += std::string("BinaryDataByteOrderMSB = ") + (kIsBig ? "True" : "False");
    text += std::string("\nCompressedData = ") + (request.compressed ? "True" : "False");
    // Whoever reads these files takes a scan's world for left-posterior-superior.
    const auto turn = spaceToSpace(request.place.space, "LPS");
    const openvdb::Mat4d toWorld = turn ? request.toWorld * *turn : request.toWorld;
    openvdb::Vec3d spacing;
    std::string directions;
    for (int axis = 0; axis < 3; ++axis) {
        const openvdb::Vec3d step = rowOf(toWorld, axis);
        spacing[axis] = step.length();
        directions += " " + threeTexts(step / spacing[axis], " ");
    }
    text += "\nTransformMatrix =" + directions;
    text += "\nOffset = " + threeTexts(rowOf(toWorld, 3), " ");
    text += "\nCenterOfRotation = 0 0 0";
    if (turn) text += "\nAnatomicalOrientation = " + axesFrom(toWorld);
    text += "\nElementSpacing = " + threeTexts(spacing, " ");
    text += "\nDimSize = " + sizeText(request.size, " ");
    text += std::string("\nElementType = ") + wordFor(request.type, kWords, "MetaImage");
    text += "\nElementDataFile = ";
    return text + (request.valuesFile.empty() ? "LOCAL" : request.valuesFile) + "\n";
}

}  // namespace bandvox

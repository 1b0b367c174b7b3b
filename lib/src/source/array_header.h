#pragma once

#include <bandvox/source/array_source.h>

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// A type of number in a file.
enum class ArrayType {
    Bool,
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Half,
    Float,
    Double
};

/// "uint16", ...
const char* nameOf(ArrayType type);
std::size_t bytesOf(ArrayType type);
/// The type of that name. Throws std::logic_error if there is none.
ArrayType typeNamed(const std::string& name);

/// What a header says: where the values are and how they are stored.
struct ArrayHeader {
    ArrayInfo info;
    ArrayType type = ArrayType::UInt8;
    bool bigEndian = false;
    enum class Encoding { Raw, Zlib, Text } encoding = Encoding::Raw;
    std::vector<std::filesystem::path> files;  ///< one after another
    std::int64_t skipLines = 0;                ///< before the values of each file, uncompressed
    std::int64_t skipBytes = 0;                ///< the same; -1: all but the values, at the end
};

/// Throws Error(ErrorKind::Input) that names the file.
[[noreturn]] void failArray(const std::filesystem::path& path, const std::string& why);

/// Numbers in a text, of which there must be so many.
std::vector<double> numbersIn(const std::filesystem::path& path, std::string_view text,
                              std::size_t count, const std::string& what);

/// Sizes of an array. Throws Error(ErrorKind::Input) for such as cannot be.
openvdb::Coord arraySize(const std::filesystem::path& path, const std::vector<double>& sizes);

/// What the header of a .npy file says.
struct NpyLayout {
    ArrayType type = ArrayType::Double;
    bool bigEndian = false;
    bool isFortran = false;     ///< the first index runs fastest
    std::vector<double> sizes;  ///< whole numbers, as there are in the file
};

/// Reads that of an array with so many indices; the stream is then behind it. Throws
/// Error(ErrorKind::Input).
NpyLayout readNpyLayout(const std::filesystem::path& path, std::istream& stream,
                        std::size_t dimensions);

// Read the header of each format; the stream is then behind it.
ArrayHeader readNpyHeader(const std::filesystem::path& path, std::istream& stream);
ArrayHeader readNrrdHeader(const std::filesystem::path& path, std::istream& stream);
ArrayHeader readMetaImageHeader(const std::filesystem::path& path, std::istream& stream);

/// Turns so many stored numbers into floats, or doubles.
void toFloats(const char* bytes, std::span<float> values, ArrayType type, bool bigEndian);
void toDoubles(const char* bytes, std::span<double> values, ArrayType type, bool bigEndian);

}  // namespace bandvox

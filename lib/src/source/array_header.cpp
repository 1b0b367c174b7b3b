#include "source/array_header.h"

#include "core/words.h"

#include <bandvox/core/error.h>

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace bandvox {

namespace {

struct TypeEntry {
    ArrayType type;
    const char* name;
    std::size_t bytes;
};

constexpr std::array kTypes{
    TypeEntry{ArrayType::Bool, "bool", 1},     TypeEntry{ArrayType::Int8, "int8", 1},
    TypeEntry{ArrayType::UInt8, "uint8", 1},   TypeEntry{ArrayType::Int16, "int16", 2},
    TypeEntry{ArrayType::UInt16, "uint16", 2}, TypeEntry{ArrayType::Int32, "int32", 4},
    TypeEntry{ArrayType::UInt32, "uint32", 4}, TypeEntry{ArrayType::Int64, "int64", 8},
    TypeEntry{ArrayType::UInt64, "uint64", 8}, TypeEntry{ArrayType::Half, "float16", 2},
    TypeEntry{ArrayType::Float, "float32", 4}, TypeEntry{ArrayType::Double, "float64", 8}};

const TypeEntry& entryOf(ArrayType type) {
    return kTypes[static_cast<std::size_t>(type)];
}

template <typename Stored, typename Number>
void convertAll(const char* bytes, std::span<Number> values, bool swaps) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::array<char, sizeof(Stored)> raw;
        std::memcpy(raw.data(), bytes + i * sizeof(Stored), sizeof(Stored));
        if (swaps) std::reverse(raw.begin(), raw.end());
        values[i] = static_cast<Number>(std::bit_cast<Stored>(raw));
    }
}

template <typename Number>
void toNumbers(const char* bytes, std::span<Number> values, ArrayType type, bool bigEndian) {
    const bool swaps = bigEndian != (std::endian::native == std::endian::big);
    switch (type) {
        case ArrayType::Bool:
        case ArrayType::UInt8:
            return convertAll<std::uint8_t>(bytes, values, swaps);
        case ArrayType::Int8:
            return convertAll<std::int8_t>(bytes, values, swaps);
        case ArrayType::Int16:
            return convertAll<std::int16_t>(bytes, values, swaps);
        case ArrayType::UInt16:
            return convertAll<std::uint16_t>(bytes, values, swaps);
        case ArrayType::Int32:
            return convertAll<std::int32_t>(bytes, values, swaps);
        case ArrayType::UInt32:
            return convertAll<std::uint32_t>(bytes, values, swaps);
        case ArrayType::Int64:
            return convertAll<std::int64_t>(bytes, values, swaps);
        case ArrayType::UInt64:
            return convertAll<std::uint64_t>(bytes, values, swaps);
        case ArrayType::Half:
            return convertAll<Imath::half>(bytes, values, swaps);
        case ArrayType::Float:
            return convertAll<float>(bytes, values, swaps);
        case ArrayType::Double:
            return convertAll<double>(bytes, values, swaps);
    }
}

}  // namespace

const char* nameOf(ArrayType type) {
    return entryOf(type).name;
}

std::size_t bytesOf(ArrayType type) {
    return entryOf(type).bytes;
}

ArrayType typeNamed(const std::string& name) {
    for (const TypeEntry& entry : kTypes) {
        if (entry.name == name) return entry.type;
    }
    throw std::logic_error("there is no type of numbers named " + name);
}

void failArray(const std::filesystem::path& path, const std::string& why) {
    throw Error(ErrorKind::Input, path.string() + ": " + why);
}

std::vector<double> numbersIn(const std::filesystem::path& path, std::string_view text,
                              std::size_t count, const std::string& what) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    constexpr std::string_view kBetween = " \t\r\n,()";
    while (true) {
        while (at != end && kBetween.find(*at) != std::string_view::npos) ++at;
        if (at == end) break;
        double number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || !std::isfinite(number)) break;
        numbers.push_back(number);
        at = next;
    }
    if (at != end || numbers.size() != count) {
        failArray(path, "its " + what + " are '" + std::string(text.substr(0, 100)) +
                            "'; expected " + std::to_string(count) + " numbers");
    }
    return numbers;
}

openvdb::Coord arraySize(const std::filesystem::path& path, const std::vector<double>& sizes) {
    constexpr double kLargest = 1 << 20;
    openvdb::Coord size(1);
    for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
        if (!(sizes[axis] >= 1 && sizes[axis] <= kLargest) ||
            sizes[axis] != std::floor(sizes[axis])) {
            failArray(path, "it has " + inShort(sizes[axis]) +
                                " values along an axis; expected a whole number from 1 to 2^20");
        }
        size[static_cast<int>(axis)] = static_cast<int>(sizes[axis]);
    }
    return size;
}

void toFloats(const char* bytes, std::span<float> values, ArrayType type, bool bigEndian) {
    toNumbers(bytes, values, type, bigEndian);
}

void toDoubles(const char* bytes, std::span<double> values, ArrayType type, bool bigEndian) {
    toNumbers(bytes, values, type, bigEndian);
}

}  // namespace bandvox

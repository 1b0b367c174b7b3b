#include "words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace bandvox::app {
namespace {

std::string hexadecimal(unsigned char byte) {
    std::array<char, 8> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "\\x%02x", byte);
    return buffer.data();
}

}  // namespace

std::string formatNumber(double value, int digits) {
    std::array<char, 64> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
    return buffer.data();
}

std::string formatVector(const openvdb::Vec3d& vector, int digits) {
    return "(" + formatNumber(vector.x(), digits) + ", " + formatNumber(vector.y(), digits) + ", " +
           formatNumber(vector.z(), digits) + ")";
}

std::string formatSize(const openvdb::Coord& size) {
    std::string text = std::to_string(size.x());
    text += " x " + std::to_string(size.y());
    text += " x " + std::to_string(size.z());
    return text;
}

std::string formatBytes(std::int64_t bytes) {
    if (bytes < 1000) return std::to_string(bytes) + " bytes";
    constexpr std::array kUnits{"kB", "MB", "GB", "TB"};
    double size = static_cast<double>(bytes) / 1000;
    std::size_t unit = 0;
    while (size >= 999.5 && unit + 1 < kUnits.size()) {
        size /= 1000;
        ++unit;
    }
    return formatNumber(size, 3) + " " + kUnits[unit];
}

std::string formatCount(std::int64_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string joined(const std::vector<std::string>& strings, const std::string& separator) {
    std::string all;
    for (std::size_t i = 0; i < strings.size(); ++i) {
        if (i > 0) all += separator;
        all += strings[i];
    }
    return all;
}

std::string printable(const std::string& text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (c == '\n') {
            shown += "\\n";
        } else if (c == '\t') {
            shown += "\\t";
        } else if (c < 0x20 || c == 0x7f) {
            shown += hexadecimal(c);
        } else if (c == 0xc2 && next >= 0x80 && next < 0xa0) {
            // The second set of control characters, in UTF-8.
            shown += hexadecimal(next);
            ++i;
        } else {
            shown += text[i];
        }
    }
    return shown;
}

std::string shellWord(const std::string& text) {
    const bool isPlain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c >= 0x80 ||
               std::string_view("_-./:,+@%=").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (isPlain && !text.empty()) return text;
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

}  // namespace bandvox::app

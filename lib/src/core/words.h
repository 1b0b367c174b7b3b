#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace bandvox {

/// A number for a message: three significant digits, whatever its size.
inline std::string inShort(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

/// A number for a message that a user has given: as many digits as that took.
inline std::string inFull(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

/// "1 hole", "2 holes".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace bandvox

#pragma once

#include <cstdio>
#include <string>

namespace bandvox {

/// A number for a message: three significant digits, whatever its size.
inline std::string inShort(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

}  // namespace bandvox

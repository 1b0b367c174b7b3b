#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace bandvox {

/// The letters A to Z of a text as a to z.
inline std::string inLowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The extension of a file's name with its dot, in lower case.
inline std::string lowerExtension(const std::filesystem::path& path) {
    return inLowerCase(path.extension().string());
}

}  // namespace bandvox

#pragma once

#include "build_places.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app_test {

using Names = std::vector<std::string>;

inline const std::string kTeapotFile =
    (std::filesystem::path(build_places::sources()) / "examples" / "data" / "teapot.bpt").string();

// A quarter of a cylinder, rational, of degrees 2 and 1.
inline const std::string kCylinder =
    "v 1 0 0\nv 1 1 0 0.7071067811865476\nv 0 1 0\nv 1 0 2\nv 1 1 2 0.7071067811865476\nv 0 1 2\n"
    "cstype rat bezier\ndeg 2 1\nsurf 0 1 0 1 1 2 3 4 5 6\nparm u 0 1\nparm v 0 1\nend\n";

/// How often a word is in a text.
inline std::size_t occurrences(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++count;
    }
    return count;
}

}  // namespace bandvox::app_test

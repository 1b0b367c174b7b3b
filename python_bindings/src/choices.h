#pragma once

#include <bandvox/core/error.h>

#include <algorithm>
#include <string>
#include <vector>

namespace bandvox::python {

/// The number of a word among those that are allowed. Throws Error(ErrorKind::Usage) that lists
/// them.
inline std::size_t choiceOf(const std::string& word, const std::vector<std::string>& allowed,
                            const char* what) {
    const auto found = std::find(allowed.begin(), allowed.end(), word);
    if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
    std::string message = std::string(what) + " is '" + word + "'; expected one of";
    for (const std::string& one : allowed) message += " '" + one + "'";
    throw Error(ErrorKind::Usage, message);
}

}  // namespace bandvox::python

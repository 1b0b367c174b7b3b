#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace bandvox {

/// A name of files with a place for a number, as "slice.####.tif" or "slice%04d.tif".
struct NumberPattern {
    std::string before, after;  ///< the name around the place; the folder in front
    int digits = 1;             ///< at least; there are zeros in front

    /// Nothing if the last part of the path has no such place, or if there is a file of that very
    /// name.
    static std::optional<NumberPattern> parse(const std::filesystem::path& path);

    /// The name with a number, at least 0.
    std::filesystem::path with(int number) const;

    /// The number of a name made by with(); nothing for other names.
    std::optional<int> numberOf(const std::filesystem::path& path) const;

    std::filesystem::path folder() const;
};

}  // namespace bandvox

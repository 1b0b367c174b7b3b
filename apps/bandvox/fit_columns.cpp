#include "fit_columns.h"

#include "words.h"

#include <array>
#include <optional>

namespace bandvox::app {
namespace {

bool areColors(const std::vector<std::string>& names, std::size_t first) {
    constexpr std::array<std::array<const char*, 3>, 3> kKnown{
        {{"r", "g", "b"}, {"red", "green", "blue"}, {"cd.r", "cd.g", "cd.b"}}};
    if (first + 3 > names.size()) return false;
    for (const auto& three : kKnown) {
        if (lowerCase(names[first]) == three[0] && lowerCase(names[first + 1]) == three[1] &&
            lowerCase(names[first + 2]) == three[2]) {
            return true;
        }
    }
    return false;
}

/// What three columns named after the axes are components of.
std::optional<std::string> vectorOf(const std::vector<std::string>& names, std::size_t first) {
    if (first + 3 > names.size()) return std::nullopt;
    const std::array<std::string, 3> three{lowerCase(names[first]), lowerCase(names[first + 1]),
                                           lowerCase(names[first + 2])};
    if (three == std::array<std::string, 3>{"u", "v", "w"}) return "vel";
    std::string stem = names[first];
    if (stem.size() < 2) return std::nullopt;
    stem.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
        if (three[k] != lowerCase(stem) + "xyz"[k]) return std::nullopt;
    }
    if (stem.back() == '.' || stem.back() == '_') stem.pop_back();
    if (stem.empty()) return std::nullopt;
    return lowerCase(stem) == "v" || lowerCase(stem) == "velocity" ? "vel" : stem;
}

}  // namespace

int redColumn(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (areColors(names, i)) return static_cast<int>(i);
    }
    return -1;
}

std::vector<ColumnGrid> gridsOfColumns(const std::vector<std::string>& names) {
    std::vector<ColumnGrid> grids;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const int column = static_cast<int>(i);
        if (areColors(names, i)) {
            grids.push_back({"Cd", column, 3, openvdb::VEC_INVARIANT});
            i += 2;
        } else if (const auto stem = vectorOf(names, i)) {
            const bool moves = *stem == "vel";
            grids.push_back({*stem, column, 3,
                             moves ? openvdb::VEC_CONTRAVARIANT_RELATIVE : openvdb::VEC_INVARIANT});
            i += 2;
        } else {
            grids.push_back(
                {names[i] == "value" ? "density" : names[i], column, 1, openvdb::VEC_INVARIANT});
        }
    }
    return grids;
}

}  // namespace bandvox::app

#include "scatter/point_taker.h"

#include "core/letter_case.h"
#include "core/words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

namespace bandvox {

std::size_t PointTaker::chosen(const std::string& name, std::size_t width) const {
    for (std::size_t i = 0; i < mNames.size(); ++i) {
        if (inLowerCase(mNames[i]) == inLowerCase(name)) return i;
    }
    std::size_t number = 0;
    const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (status == std::errc() && end == name.data() + name.size() && number >= 1 &&
        number <= width) {
        return number - 1;
    }
    std::string message = "there is no column '" + name + "'; expected a number from 1 to ";
    message += std::to_string(width);
    for (const std::string& known : mNames) message += ", '" + known + "'";
    throw Error(ErrorKind::Usage, message);
}

PointTaker::PointTaker(const FileContents& file, std::size_t width, std::vector<std::string> names,
                       const PointColumnChoice& choice)
    : mPlaces(choice.isInSpace ? 3 : 2), mNames(std::move(names)) {
    const std::size_t fewest = mPlaces + 1;
    const std::string expected = choice.isInSpace ? "x, y, z and a value" : "x, y and a value";
    if (width < fewest) {
        file.fail("has " + std::to_string(width) + " columns; expected " + std::to_string(fewest) +
                  " at least: " + expected);
    }
    if (!choice.columns.empty()) {
        for (const std::string& name : choice.columns) {
            const std::size_t column = chosen(name, width);
            if (std::find(mColumns.begin(), mColumns.end(), column) != mColumns.end()) {
                throw Error(ErrorKind::Usage,
                            "column '" + name + "' is chosen twice; expected different ones");
            }
            mColumns.push_back(column);
        }
        if (mColumns.size() < fewest) {
            throw Error(ErrorKind::Usage, std::to_string(mColumns.size()) +
                                              " columns are chosen; expected " + expected);
        }
        return;
    }
    const auto named = [&](const std::string& name) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < mNames.size(); ++i) {
            if (inLowerCase(mNames[i]) == name) return i;
        }
        return std::nullopt;
    };
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < mPlaces; ++i) {
        if (const auto column = named(i == 0 ? "x" : i == 1 ? "y" : "z")) places.push_back(*column);
    }
    const bool areNamed = places.size() == mPlaces;
    for (std::size_t i = 0; i < mPlaces; ++i) mColumns.push_back(areNamed ? places[i] : i);
    const std::vector<std::size_t> taken = mColumns;
    for (std::size_t i = 0; i < width; ++i) {
        if (std::find(taken.begin(), taken.end(), i) == taken.end()) mColumns.push_back(i);
    }
}

}  // namespace bandvox

#include "option_values.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bandvox::app {
namespace {

/// The whole of `text` as a finite number, or nothing.
std::optional<double> parseNumber(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

std::optional<int> parseWhole(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

bool Range::contains(double value) const {
    return (lowOpen ? value > low : value >= low) && (highOpen ? value < high : value <= high);
}

std::string Range::text() const {
    constexpr double kUnbounded = std::numeric_limits<double>::max();
    const bool hasLow = low > -kUnbounded;
    const bool hasHigh = high < kUnbounded;
    std::string words;
    if (hasLow) words += (lowOpen ? " above " : " of at least ") + formatNumber(low);
    if (hasLow && hasHigh) words += " and";
    if (hasHigh) words += (highOpen ? " below " : " at most ") + formatNumber(high);
    return words;
}

void OptionValues::fail(const std::string& name, const std::string& expected) const {
    std::string message;
    const auto origin = mOrigins.find(name);
    if (origin != mOrigins.end() && !origin->second.empty()) message = origin->second + ": ";
    message += mTitle + name;
    message += " is '" + found(name).value_or("") + "'; expected " + expected;
    throw Error(mKind, message);
}

std::optional<std::string> OptionValues::found(const std::string& name) const {
    for (const auto* values : {&mValues, &mDefaults}) {
        const auto entry = values->find(name);
        if (entry != values->end()) return entry->second;
    }
    return std::nullopt;
}

std::optional<std::string> OptionValues::text(const std::string& name) const {
    return has(name) ? textOrDefault(name) : std::nullopt;
}

std::optional<std::string> OptionValues::textOrDefault(const std::string& name) const {
    auto value = found(name);
    if (value && value->empty()) fail(name, "a value that is not empty");
    return value;
}

double OptionValues::number(const std::string& name, const Range& range, double fallback) const {
    const auto given = textOrDefault(name);
    if (!given) return fallback;
    const auto value = parseNumber(*given);
    if (!value || !range.contains(*value)) fail(name, "a number" + range.text());
    return *value;
}

int OptionValues::wholeNumber(const std::string& name, int low, int high, int fallback) const {
    const auto given = textOrDefault(name);
    if (!given) return fallback;
    const auto value = parseWhole(*given);
    if (!value || *value < low || *value > high) {
        fail(name, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return *value;
}

std::int64_t OptionValues::bytes(const std::string& name, std::int64_t least,
                                 std::int64_t fallback) const {
    const auto given = textOrDefault(name);
    if (!given) return fallback;
    constexpr std::string_view kUnits = "KMGT";
    constexpr double kMost = 1e18;
    std::string_view number = *given;
    double unit = 1;
    const std::size_t place = kUnits.find(number.back());
    if (place != std::string_view::npos) {
        unit = std::pow(1024.0, static_cast<double>(place + 1));
        number.remove_suffix(1);
    }
    const auto value = parseNumber(number);
    if (!value || *value * unit < static_cast<double>(least) || *value * unit > kMost) {
        fail(name, "a size of at least " + std::to_string(least) + " bytes, as 800M or 2G");
    }
    return static_cast<std::int64_t>(*value * unit);
}

std::optional<openvdb::Vec3d> OptionValues::vector(const std::string& name,
                                                   const Range& range) const {
    const auto given = textOrDefault(name);
    if (!given) return std::nullopt;
    const std::vector<std::string_view> parts = split(*given, ',');
    openvdb::Vec3d vector(0.0);
    bool good = parts.size() == 3;
    for (int i = 0; good && i < 3; ++i) {
        const auto value = parseNumber(parts[static_cast<std::size_t>(i)]);
        good = value && range.contains(*value);
        if (good) vector[i] = *value;
    }
    if (!good) {
        fail(name, "three numbers" + range.text() + " separated by commas, as in 0.1,0.2,0.3");
    }
    return vector;
}

std::optional<std::vector<double>> OptionValues::numbers(const std::string& name, std::size_t least,
                                                         std::size_t most,
                                                         const std::string& expected,
                                                         const Range& each) const {
    const auto given = textOrDefault(name);
    if (!given) return std::nullopt;
    std::vector<double> numbers;
    for (const std::string_view part : split(*given, ',')) {
        const auto value = parseNumber(part);
        if (!value || !each.contains(*value)) fail(name, expected);
        numbers.push_back(*value);
    }
    if (numbers.size() < least || numbers.size() > most) fail(name, expected);
    return numbers;
}

std::optional<std::vector<int>> OptionValues::wholeNumbers(const std::string& name,
                                                           std::size_t count,
                                                           char separator) const {
    const auto given = textOrDefault(name);
    if (!given) return std::nullopt;
    std::vector<int> numbers;
    for (const std::string_view part : split(*given, separator)) {
        const auto value = parseWhole(part);
        if (value) numbers.push_back(*value);
    }
    if (numbers.size() != count || split(*given, separator).size() != count) {
        fail(name, std::to_string(count) + " whole numbers separated by '" + separator + "'");
    }
    return numbers;
}

std::optional<openvdb::Vec2i> OptionValues::size(const std::string& name, int low, int high) const {
    const auto given = textOrDefault(name);
    if (!given) return std::nullopt;
    const std::vector<std::string_view> parts = split(*given, 'x');
    std::optional<int> width, height;
    if (parts.size() == 2) {
        width = parseWhole(parts[0]);
        height = parseWhole(parts[1]);
    }
    const auto good = [&](const std::optional<int>& side) {
        return side && *side >= low && *side <= high;
    };
    if (!good(width) || !good(height)) {
        fail(name, "WIDTHxHEIGHT, each from " + std::to_string(low) + " to " +
                       std::to_string(high) + ", as in 1920x1080");
    }
    return openvdb::Vec2i(*width, *height);
}

std::size_t OptionValues::choice(const std::string& name, const std::vector<std::string>& choices,
                                 std::size_t fallback) const {
    const auto given = textOrDefault(name);
    if (!given) return fallback;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (*given == choices[i]) return i;
    }
    fail(name, "one of " + joined(choices, ", "));
}

std::vector<bool> OptionValues::choices(const std::string& name,
                                        const std::vector<std::string>& choices) const {
    const auto given = textOrDefault(name);
    if (!given) return std::vector<bool>(choices.size(), true);
    std::vector<bool> chosen(choices.size(), false);
    for (const std::string_view part : split(*given, ',')) {
        const auto found = std::find(choices.begin(), choices.end(), part);
        if (found == choices.end()) fail(name, "some of " + joined(choices, ","));
        chosen[static_cast<std::size_t>(found - choices.begin())] = true;
    }
    return chosen;
}

}  // namespace bandvox::app

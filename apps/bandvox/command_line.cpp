#include "command_line.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <boost/program_options.hpp>

#include <charconv>
#include <cmath>

namespace po = boost::program_options;

namespace bandvox::app {
namespace {

[[noreturn]] void throwUsage(const std::string& message) {
    throw Error(ErrorKind::Usage, message);
}

po::options_description describe(const CommandTable& table) {
    po::options_description description;
    for (const OptionEntry& option : allOptions(table)) {
        std::string names = option.name;
        if (option.letter) names += std::string(",") + option.letter;
        if (option.argument.empty()) {
            description.add_options()(names.c_str(), option.help.c_str());
        } else {
            description.add_options()(names.c_str(), po::value<std::string>(), option.help.c_str());
        }
    }
    return description;
}

[[noreturn]] void throwUnknownOption(const CommandTable& table, const std::string& given) {
    std::vector<std::string> names;
    for (const OptionEntry& option : allOptions(table)) names.push_back(option.name);
    std::string bare = given.substr(std::min(given.find_first_not_of('-'), given.size()));
    bare = bare.substr(0, bare.find('='));
    const std::string nearest = nearestName(bare, names);
    throwUsage("unknown option '" + given + "' for '" + table.name + "'; " +
               (nearest.empty() ? "'bandvox " + table.name + " --help' lists them all"
                                : "did you mean '--" + nearest + "'?"));
}

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

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

[[noreturn]] void throwValue(const std::string& option, const std::string& found,
                             const std::string& expected) {
    throwUsage("option --" + option + " is '" + found + "'; expected " + expected);
}

}  // namespace

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

CommandLine::CommandLine(const CommandTable& table, const std::vector<std::string>& arguments)
    : mTable(table) {
    namespace style = po::command_line_style;
    try {
        const po::options_description description = describe(table);
        const po::parsed_options parsed = po::command_line_parser(arguments)
                                              .options(description)
                                              .style(style::unix_style & ~style::allow_guessing)
                                              .run();
        // Storing checks for repetition and missing values.
        po::variables_map values;
        po::store(parsed, values);
        for (const auto& option : parsed.options) {
            if (option.position_key >= 0) {
                mPositionals.insert(mPositionals.end(), option.value.begin(), option.value.end());
            }
        }
        for (const auto& [name, value] : values) {
            const auto* text = boost::any_cast<std::string>(&value.value());
            mValues[name] = text ? *text : std::string();
        }
    } catch (const po::unknown_option& error) {
        throwUnknownOption(table, error.get_option_name());
    } catch (const po::error& error) {
        throwUsage(error.what());
    }
}

std::optional<std::string> CommandLine::text(const std::string& option) const {
    const auto found = mValues.find(option);
    if (found == mValues.end()) return std::nullopt;
    if (found->second.empty()) throwValue(option, "", "a value that is not empty");
    return found->second;
}

std::string CommandLine::requiredText(const std::string& option) const {
    if (const auto given = text(option)) return *given;
    std::string shown = "--" + option;
    for (const OptionEntry& entry : mTable.options) {
        if (entry.name == option && entry.letter) shown = std::string{'-', entry.letter};
    }
    throwUsage("'" + mTable.name + "' needs " + shown + "; see 'bandvox " + mTable.name +
               " --help'");
}

double CommandLine::number(const std::string& option, const Range& range, double fallback) const {
    const auto given = text(option);
    if (!given) return fallback;
    const auto value = parseNumber(*given);
    if (!value || !range.contains(*value)) throwValue(option, *given, "a number" + range.text());
    return *value;
}

int CommandLine::wholeNumber(const std::string& option, int low, int high, int fallback) const {
    const auto given = text(option);
    if (!given) return fallback;
    const auto value = parseWhole(*given);
    if (!value || *value < low || *value > high) {
        throwValue(option, *given,
                   "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return *value;
}

std::optional<openvdb::Vec3d> CommandLine::vector(const std::string& option,
                                                  const Range& range) const {
    const auto given = text(option);
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
        throwValue(option, *given,
                   "three numbers" + range.text() + " separated by commas, as in 0.1,0.2,0.3");
    }
    return vector;
}

std::optional<openvdb::Vec2i> CommandLine::size(const std::string& option, int low,
                                                int high) const {
    const auto given = text(option);
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
        throwValue(option, *given,
                   "WIDTHxHEIGHT, each from " + std::to_string(low) + " to " +
                       std::to_string(high) + ", as in 1920x1080");
    }
    return openvdb::Vec2i(*width, *height);
}

std::size_t CommandLine::choice(const std::string& option, const std::vector<std::string>& choices,
                                std::size_t fallback) const {
    const auto given = text(option);
    if (!given) return fallback;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        if (*given == choices[i]) return i;
    }
    throwValue(option, *given, "one of " + joined(choices, ", "));
}

void CommandLine::requirePositionals() const {
    std::vector<std::string> names;
    for (const PositionalEntry& positional : mTable.positionals) names.push_back(positional.name);
    const std::string see = "; see 'bandvox " + mTable.name + " --help'";
    if (mPositionals.size() < names.size()) {
        throwUsage("'" + mTable.name + "' needs " + names[mPositionals.size()] + see);
    }
    if (mPositionals.size() > names.size()) {
        throwUsage("'" + mTable.name + "' takes " + joined(names, " ") + " only; found '" +
                   mPositionals[names.size()] + "' after that" + see);
    }
}

}  // namespace bandvox::app

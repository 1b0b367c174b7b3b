#include "command_line.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <boost/program_options.hpp>

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

}  // namespace

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
            set(name, text ? *text : std::string());
        }
    } catch (const po::unknown_option& error) {
        throwUnknownOption(table, error.get_option_name());
    } catch (const po::error& error) {
        throwUsage(error.what());
    }
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

void CommandLine::requirePositionals() const {
    std::vector<std::string> names;
    for (const PositionalEntry& positional : mTable.positionals) names.push_back(positional.name);
    const std::string see = "; see 'bandvox " + mTable.name + " --help'";
    if (mPositionals.size() < names.size()) {
        throwUsage("'" + mTable.name + "' needs " + names[mPositionals.size()] + see);
    }
    const bool mayRepeat = !names.empty() && mTable.positionals.back().repeated;
    if (mPositionals.size() > names.size() && !mayRepeat) {
        throwUsage("'" + mTable.name + "' takes " + joined(names, " ") + " only; found '" +
                   mPositionals[names.size()] + "' after that" + see);
    }
}

}  // namespace bandvox::app

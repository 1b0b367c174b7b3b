#include "command_line.h"

#include "config_file.h"
#include "words.h"

#include <bandvox/core/error.h>

#include <boost/program_options.hpp>

#include <algorithm>
#include <optional>
#include <utility>

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
    std::string bare = given.substr(std::min(given.find_first_not_of('-'), given.size()));
    bare = bare.substr(0, bare.find('='));
    throwUsage("unknown option '" + given + "' for '" + table.name + "'; " +
               suggestionFor(table, bare));
}

// Whether an argument is --flag=true or --flag=false.
std::optional<std::pair<std::string, bool>> flagSetting(const CommandTable& table,
                                                        const std::string& argument) {
    const std::size_t equals = argument.find('=');
    if (!argument.starts_with("--") || equals == std::string::npos) return std::nullopt;
    const std::string name = argument.substr(2, equals - 2);
    const std::string value = argument.substr(equals + 1);
    const OptionEntry* option = findOption(table, name);
    if (option == nullptr || !option->argument.empty()) return std::nullopt;
    if (value != "true" && value != "false") return std::nullopt;
    return std::pair(name, value == "true");
}

}  // namespace

CommandLine::CommandLine(const CommandTable& table, const std::vector<std::string>& arguments)
    : mTable(table) {
    std::vector<std::string> others;
    std::vector<std::string> flagsOff;
    bool optionsEnded = false;
    for (const std::string& argument : arguments) {
        optionsEnded = optionsEnded || argument == "--";
        const auto flag = optionsEnded ? std::nullopt : flagSetting(table, argument);
        if (!flag || flag->second) {
            others.push_back(flag ? "--" + flag->first : argument);
        } else if (!mDecided.insert(flag->first).second) {
            throwUsage("option '--" + flag->first + "' cannot be specified more than once");
        } else {
            flagsOff.push_back(flag->first);
        }
    }
    parse(others);
    for (const std::string& flag : flagsOff) {
        if (has(flag)) throwUsage("option '--" + flag + "' cannot be both true and false");
    }
    for (const auto& [name, value] : all()) mDecided.insert(name);
    const auto config = text("config");
    if (!config) return;
    const std::vector<ConfigEntry> entries = readConfigFile(*config, table);
    std::vector<const ConfigEntry*> taken;
    for (const ConfigEntry& entry : entries) {
        if (!decides(entry.name)) taken.push_back(&entry);
    }
    // Not before all are looked at: within the file none of them wins over another.
    for (const ConfigEntry* entry : taken) {
        mDecided.insert(entry->name);
        const OptionEntry* option = findOption(table, entry->name);
        if (!option->argument.empty()) {
            set(entry->name, entry->value, entry->origin);
        } else if (entry->value == "true") {
            set(entry->name, "", entry->origin);
        }
    }
}

void CommandLine::parse(const std::vector<std::string>& arguments) {
    namespace style = po::command_line_style;
    try {
        const po::options_description description = describe(mTable);
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
        throwUnknownOption(mTable, error.get_option_name());
    } catch (const po::error& error) {
        throwUsage(error.what());
    }
}

bool CommandLine::decides(const std::string& option) const {
    if (mDecided.contains(option)) return true;
    const std::vector<std::string> others = ruledOut(mTable, option);
    return std::any_of(others.begin(), others.end(),
                       [&](const std::string& other) { return has(other); });
}

void CommandLine::setUndecided(const std::string& option, const std::string& value,
                               const std::string& origin) {
    if (!mDecided.contains(option)) set(option, value, origin);
}

CommandLine CommandLine::withFiles(const std::string& input, const std::string& output) const {
    CommandLine changed = *this;
    changed.mPositionals.at(0) = input;
    changed.set("output", output);
    return changed;
}

std::size_t CommandLine::choice(const std::string& option, std::size_t fallback) const {
    return choice(option, findOption(mTable, option)->hint.words, fallback);
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

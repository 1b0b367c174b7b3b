#include "config_file.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

// A file of options is read by people: what is longer is some other file.
constexpr std::size_t kLongestLine = 64 * 1024;

const char* const kSpaces = " \t\r\n\v\f";

bool isSpace(char c) {
    return std::strchr(kSpaces, c) != nullptr;
}

// A '#' within a word is a part of it, as in name.####.vdb.
std::string withoutComment(const std::string& line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '#' && (i == 0 || isSpace(line[i - 1]))) return line.substr(0, i);
    }
    return line;
}

[[noreturn]] void failAt(const std::string& origin, const std::string& message) {
    throw Error(ErrorKind::Usage, origin + ": " + message);
}

ConfigEntry readEntry(const std::string& text, const std::string& origin,
                      const CommandTable& table) {
    if (text.front() == '[') {
        failAt(origin, "'" + text + "' begins a section; expected lines name = value alone");
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        failAt(origin, "found '" + text + "'; expected name = value, as in resolution = 512");
    }
    ConfigEntry entry{trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1)), origin};
    const OptionEntry* option = findOption(table, entry.name);
    if (option == nullptr) {
        std::string message = "unknown option '" + entry.name;
        message += "' for '" + table.name + "'; " + suggestionFor(table, entry.name);
        failAt(origin, message);
    }
    if (entry.name == "config" || entry.name == "help" || entry.name == "version") {
        failAt(origin, "'" + entry.name + "' is for the command line alone");
    }
    if (option->argument.empty() && entry.value != "true" && entry.value != "false") {
        failAt(origin,
               "option " + entry.name + " is '" + entry.value + "'; expected true or false");
    }
    if (entry.value.empty()) {
        failAt(origin, "option " + entry.name + " is ''; expected a value that is not empty");
    }
    return entry;
}

}  // namespace

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(kSpaces);
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(kSpaces) + 1 - begin);
}

std::vector<ConfigEntry> readConfigFile(const fs::path& path, const CommandTable& table) {
    const auto fail = [&](const std::string& why) {
        return Error(ErrorKind::Input,
                     "cannot read the options in '" + path.string() + "': " + why);
    };
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) throw fail("it is a folder; expected a file");
    std::ifstream file(path);
    if (!file) throw fail(std::strerror(errno));
    std::vector<ConfigEntry> entries;
    std::map<std::string, int> lineOf;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        const std::string origin = path.string() + ":" + std::to_string(number);
        if (line.size() > kLongestLine || line.find('\0') != std::string::npos) {
            failAt(origin, "this is no line of text; expected name = value");
        }
        const std::string text = trimmed(withoutComment(line));
        if (text.empty()) continue;
        ConfigEntry entry = readEntry(text, origin, table);
        const auto [earlier, isNew] = lineOf.emplace(entry.name, number);
        if (!isNew) {
            failAt(origin, "option " + entry.name + " stands in line " +
                               std::to_string(earlier->second) + " already; expected it once");
        }
        entries.push_back(std::move(entry));
    }
    if (file.bad()) throw fail(std::strerror(errno));
    return entries;
}

}  // namespace bandvox::app

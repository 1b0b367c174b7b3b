#include "core/number_pattern.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

namespace bandvox {

namespace {

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// A run of '#', or nothing.
std::optional<NumberPattern> parseHashes(const std::string& name, std::size_t start) {
    const std::size_t begin = name.find('#', start);
    if (begin == std::string::npos) return std::nullopt;
    const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
    return NumberPattern{name.substr(0, begin), name.substr(end), static_cast<int>(end - begin)};
}

// %d or %04d, or nothing.
std::optional<NumberPattern> parsePercent(const std::string& name, std::size_t start) {
    std::size_t begin = name.find('%', start);
    for (; begin != std::string::npos; begin = name.find('%', begin + 1)) {
        std::size_t end = begin + 1;
        while (end < name.size() && isDigit(name[end])) ++end;
        if (end == name.size() || name[end] != 'd' || end - begin > 3) continue;
        int digits = 1;
        std::from_chars(name.data() + begin + 1, name.data() + end, digits);
        return NumberPattern{name.substr(0, begin), name.substr(end + 1), std::max(digits, 1)};
    }
    return std::nullopt;
}

}  // namespace

std::optional<NumberPattern> NumberPattern::parse(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::string name = path.string();
    const std::size_t slash = name.rfind('/');
    const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
    std::optional<NumberPattern> found = parseHashes(name, start);
    if (!found) found = parsePercent(name, start);
    if (found && std::filesystem::exists(path, ignored)) return std::nullopt;
    return found;
}

std::filesystem::path NumberPattern::with(int number) const {
    std::string text = std::to_string(number);
    if (static_cast<int>(text.size()) < digits)
        text.insert(0, static_cast<std::size_t>(digits) - text.size(), '0');
    return before + text + after;
}

std::optional<int> NumberPattern::numberOf(const std::filesystem::path& path) const {
    const std::string name = path.string();
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after)) {
        return std::nullopt;
    }
    const char* const begin = name.data() + before.size();
    const char* const end = name.data() + name.size() - after.size();
    int number = 0;
    const auto [stop, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || stop != end || number < 0 || with(number) != path) {
        return std::nullopt;
    }
    return number;
}

std::filesystem::path NumberPattern::folder() const {
    const std::filesystem::path parent = std::filesystem::path(before + "x").parent_path();
    return parent.empty() ? std::filesystem::path(".") : parent;
}

}  // namespace bandvox

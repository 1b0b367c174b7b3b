#include "shell_completion.h"

#include <algorithm>

namespace bandvox::app {

std::string shortHelp(const std::string& help) {
    constexpr std::size_t kLongest = 70;
    std::string text = help.substr(0, std::min(help.find(". "), help.find('\n')));
    if (text.ends_with('.') && !text.ends_with("..")) text.pop_back();
    if (text.size() <= kLongest) return text;
    // What is cut off ends before a word, so no character of several bytes is cut up.
    const std::size_t space = text.rfind(' ', kLongest);
    return text.substr(0, space) + " ...";
}

std::string singleQuoted(const std::string& text, const std::string& quote) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') {
            out += quote;
        } else {
            out += c;
        }
    }
    return out + "'";
}

bool takesFile(const OptionEntry& option) {
    return option.argument == "FILE" || !option.hint.endings.empty();
}

}  // namespace bandvox::app

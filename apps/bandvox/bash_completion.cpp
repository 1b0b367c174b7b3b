#include "shell_completion.h"
#include "words.h"

namespace bandvox::app {
namespace {

// What is the same whatever the tables say. _init_completion and _filedir are bash-completion's.
constexpr const char* kBashHead = R"(# bash completion for bandvox(1)

_bandvox_words()
{
    COMPREPLY+=($(compgen -W "$1" -- "$cur"))
}

# One more of several words that are separated by commas.
_bandvox_list()
{
    local before=
    [[ $cur == *,* ]] && before=${cur%,*},
    COMPREPLY+=($(compgen -P "$before" -W "$1" -- "${cur##*,}"))
    compopt -o nospace
}

)";

constexpr const char* kBashTail = R"(
_bandvox()
{
    local cur prev words cword split
    # A colon is a part of a word, as in shape:torus; --name=value is taken apart.
    _init_completion -s -n : || return

    if ((cword == 1)); then
        _bandvox_words "$_bandvox_commands help --help --version"
    elif [[ ${words[1]} == help ]]; then
        ((cword == 2)) && _bandvox_words "$_bandvox_commands"
    elif declare -F "_bandvox_${words[1]}" >/dev/null &&
        [[ " $_bandvox_commands " == *" ${words[1]} "* ]]; then
        "_bandvox_${words[1]}"
    fi
    __ltrim_colon_completions "$cur"
} &&
    complete -F _bandvox bandvox
)";

/// The statements that complete what the hint describes.
std::string completing(const ValueHint& hint, bool anyFile) {
    std::string out;
    if (!hint.words.empty()) {
        out += hint.isList ? "_bandvox_list '" : "_bandvox_words '";
        out += joined(hint.words, " ") + "'";
    }
    if (!hint.endings.empty() || anyFile) {
        if (!out.empty()) out += "; ";
        std::string pattern;
        for (const std::string& ending : hint.endings) {
            pattern += (pattern.empty() ? "" : "|") + ending.substr(1);
        }
        // It completes folders, too.
        out += pattern.empty() ? "_filedir" : "_filedir '@(" + pattern + ")'";
    }
    return out;
}

std::string bashFunction(const CommandTable& table) {
    std::string names, cases, free;
    for (const OptionEntry& option : allOptions(table)) {
        std::string labels = "--" + option.name;
        names += (names.empty() ? "" : " ") + labels;
        if (option.letter) labels += std::string(" | -") + option.letter;
        if (option.argument.empty()) continue;
        const std::string statements = completing(option.hint, takesFile(option));
        if (statements.empty()) {
            free += (free.empty() ? "" : " | ") + labels;
        } else {
            cases += "        ";
            cases += labels + ") ";
            cases += statements + " ;;\n";
        }
    }
    // Nothing can be said of the values of the others, but they are no inputs.
    if (!free.empty()) cases += "        " + free + ") ;;\n";
    std::string out = "_bandvox_" + table.name + "()\n{\n    case $prev in\n" + cases;
    out += "        *)\n            if [[ $cur == -* ]]; then\n                _bandvox_words '";
    out += names + "'\n                return\n            fi\n            ";
    // What all arguments that have no name may be: which of them it is makes no difference.
    out += completing(table.positionals.back().hint, true) + "\n            ;;\n    esac\n}\n\n";
    return out;
}

}  // namespace

std::string bashCompletion(const std::vector<const CommandTable*>& tables) {
    std::string out = kBashHead, names;
    for (const CommandTable* table : tables) {
        names += (names.empty() ? "" : " ") + table->name;
        out += bashFunction(*table);
    }
    out += "_bandvox_commands='" + names + "'\n";
    return out + kBashTail;
}

}  // namespace bandvox::app

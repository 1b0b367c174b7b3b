#include "shell_completion.h"
#include "words.h"

namespace bandvox::app {
namespace {

constexpr const char* kFishHead = R"(# fish completion for bandvox(1)

function __fish_bandvox_command
    set -l words (commandline -opc)
    test (count $words) -ge 2; and test $words[2] = $argv[1]
end

function __fish_bandvox_no_command
    test (count (commandline -opc)) -eq 1
end

# Files that end like one of the arguments, and folders.
function __fish_bandvox_files
    set -l word (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    set -l files (complete -C "__fish_command_without_completions $word")
    string match -r -- '.*/$' $files
    for ending in $argv
        string match -ri -- '.*'(string escape --style=regex -- $ending)'$' $files
    end
end

# One more of several words that are separated by commas.
function __fish_bandvox_list
    set -l word (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    set -l before (string match -r -- '.*,' $word)
    for next in $argv
        echo $before$next
    end
end

complete -c bandvox -f
complete -c bandvox -n __fish_bandvox_no_command -l help -s h -d 'List the commands'
complete -c bandvox -n __fish_bandvox_no_command -l version -d 'Print the version'
complete -c bandvox -n __fish_bandvox_no_command -a help -d 'Print all options of a command'
)";

std::string quotedForFish(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\') escaped += '\\';
        escaped += c;
    }
    return singleQuoted(escaped, "\\'");
}

/// The options of `complete` that say what a value, or an argument without a name, may be.
std::string valuesFor(const ValueHint& hint, bool anyFile) {
    std::string values;
    if (!hint.words.empty()) {
        values = hint.isList ? "(__fish_bandvox_list " + joined(hint.words, " ") + ")"
                             : joined(hint.words, " ");
    }
    if (!hint.endings.empty()) {
        if (!values.empty()) values += ' ';
        values += "(__fish_bandvox_files " + joined(hint.endings, " ") + ")";
    }
    if (values.empty()) return anyFile ? " -F" : " -f";
    return " -f -a " + quotedForFish(values);
}

std::string fishCommand(const CommandTable& table) {
    const std::string start = "complete -c bandvox -n '__fish_bandvox_command " + table.name + "'";
    std::string out = "\ncomplete -c bandvox -n __fish_bandvox_no_command -a " + table.name +
                      " -d " + quotedForFish(shortHelp(table.summary)) + "\n";
    out += "complete -c bandvox -n '__fish_bandvox_command help' -a " + table.name + "\n";
    out += start + valuesFor(table.positionals.back().hint, true) + "\n";
    for (const OptionEntry& option : allOptions(table)) {
        out += start;
        out += " -l " + option.name;
        if (option.letter) out += std::string(" -s ") + option.letter;
        if (!option.argument.empty()) out += " -r" + valuesFor(option.hint, takesFile(option));
        out += " -d " + quotedForFish(shortHelp(option.help)) + "\n";
    }
    return out;
}

}  // namespace

std::string fishCompletion(const std::vector<const CommandTable*>& tables) {
    std::string out = kFishHead;
    for (const CommandTable* table : tables) out += fishCommand(*table);
    return out;
}

}  // namespace bandvox::app

#include "shell_completion.h"
#include "words.h"

namespace bandvox::app {
namespace {

std::string quotedForZsh(const std::string& text) {
    return singleQuoted(text, "'\\''");
}

/// Text in which the characters of `special` are preceded by a backslash.
std::string escapedForZsh(const std::string& text, const std::string& special) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string::npos) out += '\\';
        out += c;
    }
    return out;
}

/// What _arguments does for a value: the third part of a specification.
std::string actionFor(const ValueHint& hint, bool anyFile) {
    std::string files;
    if (!hint.endings.empty()) {
        std::string pattern;
        for (const std::string& ending : hint.endings) {
            if (!pattern.empty()) pattern += '|';
            pattern.append(ending, 1);
        }
        files = "_files -g \"(#i)*.(";
        files += pattern;
        files += ")(-.)\"";
    } else if (anyFile) {
        files = "_files";
    }
    if (hint.words.empty()) return files;
    if (hint.isList) return "_values -s , word " + joined(hint.words, " ");
    std::vector<std::string> words;
    for (const std::string& word : hint.words) words.push_back(escapedForZsh(word, ":"));
    if (files.empty()) return "(" + joined(hint.words, " ") + ")";
    return "{ compadd -- " + joined(words, " ") + "; " + files + " }";
}

std::string optionSpec(const OptionEntry& option) {
    std::string rest = "[" + escapedForZsh(shortHelp(option.help), "\\[]") + "]";
    if (!option.argument.empty()) {
        rest += ":" + escapedForZsh(option.argument, "\\:") + ":";
        rest += actionFor(option.hint, takesFile(option));
    }
    const std::string name = "--" + option.name;
    const std::string mark = option.argument.empty() ? "" : "=";
    if (option.letter == 0) return quotedForZsh(name + mark + rest);
    const std::string letter{'-', option.letter};
    return quotedForZsh("(" + letter + " " + name + ")") + "{" + letter + "," + name + mark + "}" +
           quotedForZsh(rest);
}

std::string zshFunction(const CommandTable& table) {
    std::string out = "_bandvox_" + table.name + "() {\n  _arguments -s -S \\\n";
    for (const OptionEntry& option : allOptions(table))
        out += "    " + optionSpec(option) + " \\\n";
    for (const PositionalEntry& positional : table.positionals) {
        const std::string spec = std::string(positional.repeated ? "*" : "") + ":" +
                                 escapedForZsh(positional.name, "\\:") + ":" +
                                 actionFor(positional.hint, true);
        out += "    " + quotedForZsh(spec);
        out += &positional == &table.positionals.back() ? "\n" : " \\\n";
    }
    return out + "}\n\n";
}

}  // namespace

std::string zshCompletion(const std::vector<const CommandTable*>& tables) {
    std::string out = "#compdef bandvox\n\n", described;
    for (const CommandTable* table : tables) {
        out += zshFunction(*table);
        described += "    " + quotedForZsh(table->name + ":" + shortHelp(table->summary)) + "\n";
    }
    out += "_bandvox() {\n  local curcontext=\"$curcontext\" state line ret=1\n";
    out += "  local -a commands\n  commands=(\n" + described;
    out += "    'help:Print all options of a command'\n  )\n";
    out += R"(  _arguments -C \
    '(- *)'{-h,--help}'[List the commands]' \
    '(- *)--version[Print the version]' \
    '1:command:->command' \
    '*::argument:->argument' && ret=0
  case $state in
    command)
      _describe -t commands 'bandvox command' commands && ret=0
      ;;
    argument)
      if [[ $line[1] == help ]]; then
        ((CURRENT == 2)) && _describe -t commands 'bandvox command' commands && ret=0
      elif ((${commands[(I)${(q)line[1]}:*]})); then
        curcontext="${curcontext%:*:*}:bandvox-$line[1]:"
        _bandvox_$line[1] && ret=0
      fi
      ;;
  esac
  return ret
}

_bandvox "$@"
)";
    return out;
}

}  // namespace bandvox::app

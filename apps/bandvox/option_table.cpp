#include "option_table.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <sstream>

namespace bandvox::app {
namespace {

constexpr std::size_t kHelpColumn = 30;  // where the explanations start
constexpr std::size_t kTextWidth = 96;   // where they end
constexpr std::size_t kTextIndent = 2;
constexpr std::size_t kStatusWidth = 7;

const char* const kSharedGroup = "Shared by all commands";

/// Appends `text` to `out` word by word, from the present column on, in lines that start at
/// `indent` and end before kTextWidth. A line break in `text` is kept.
void appendWrapped(std::string& out, std::string_view text, std::size_t indent) {
    const std::size_t lastBreak = out.rfind('\n');
    std::size_t column = out.size() - (lastBreak == std::string::npos ? 0 : lastBreak + 1);
    bool lineStart = true;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        for (std::string word; words >> word;) {
            const std::size_t space = lineStart ? 0 : 1;
            if (!lineStart && column + space + word.size() > kTextWidth) {
                out += '\n';
                out.append(indent, ' ');
                column = indent;
                lineStart = true;
            }
            if (!lineStart) {
                out += ' ';
                ++column;
            }
            out += word;
            column += word.size();
            lineStart = false;
        }
        if (!lines.eof()) {
            out += '\n';
            out.append(indent, ' ');
            column = indent;
            lineStart = true;
        }
    }
    out += '\n';
}

std::string optionHead(const OptionEntry& option) {
    std::string head = "  ";
    head += option.letter ? std::string{'-', option.letter} + ", " : std::string(4, ' ');
    head += "--" + option.name;
    if (!option.argument.empty()) head += ' ' + option.argument;
    return head;
}

void appendEntry(std::string& out, const std::string& head, const std::string& help) {
    out += head;
    if (head.size() + 2 > kHelpColumn) {
        out += '\n';
        out.append(kHelpColumn, ' ');
    } else {
        out += std::string(kHelpColumn - head.size(), ' ');
    }
    appendWrapped(out, help, kHelpColumn);
}

std::string optionHelp(const OptionEntry& option) {
    if (option.standard.empty()) return option.help;
    return option.help + " [" + option.standard + "]";
}

/// Edit distance in which swapping two neighbours counts once.
std::size_t editDistance(std::string_view a, std::string_view b) {
    const std::size_t columns = b.size() + 1;
    std::vector<std::size_t> beforePrevious, previous(columns), current(columns);
    std::iota(previous.begin(), previous.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j < columns; ++j) {
            const std::size_t substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], beforePrevious[j - 2] + 1);
            }
        }
        beforePrevious = previous;
        previous = current;
    }
    return previous.back();
}

}  // namespace

const std::vector<OptionEntry>& sharedOptions() {
    static const std::vector<OptionEntry> options{
        {"threads", 0, "N", "0", "Threads to work with; 0 uses all processors.", kSharedGroup},
        {"quiet", 'q', "", "", "Say nothing but warnings and errors.", kSharedGroup},
        {"verbose", 'v', "", "", "Say more: every hole, every warning, times.", kSharedGroup},
        {"progress",
         0,
         "WHEN",
         "auto",
         "Show how far the work is, on a terminal as a bar, else as lines \"Progress: 42%\": auto "
         "(not with --quiet, and lines only where there is an output), always or never.",
         kSharedGroup,
         {.words = {"auto", "always", "never"}}},
        {"config", 0, "FILE", "",
         "Read options from FILE, one \"name = value\" a line; the command line wins over it.",
         kSharedGroup},
        {"stats",
         0,
         "FILE",
         "",
         "Write seconds and counts of each stage and the peak memory to FILE, as JSON.",
         kSharedGroup,
         {.endings = {".json"}}},
        {"strict", 0, "", "", "Take a warning for a failure: write nothing.", kSharedGroup},
        {"help", 'h', "", "", "Print this text.", kSharedGroup},
        {"version", 0, "", "", "Print the version.", kSharedGroup},
    };
    return options;
}

std::vector<OptionEntry> allOptions(const CommandTable& table) {
    std::vector<OptionEntry> options = table.options;
    options.insert(options.end(), sharedOptions().begin(), sharedOptions().end());
    return options;
}

const OptionEntry* findOption(const CommandTable& table, const std::string& name) {
    for (const auto* options : {&table.options, &sharedOptions()}) {
        for (const OptionEntry& option : *options) {
            if (option.name == name) return &option;
        }
    }
    return nullptr;
}

std::vector<std::string> ruledOut(const CommandTable& table, const std::string& option) {
    std::vector<std::string> others;
    const auto addFrom = [&](const std::vector<std::string>& group) {
        if (std::find(group.begin(), group.end(), option) == group.end()) return;
        std::copy_if(group.begin(), group.end(), std::back_inserter(others),
                     [&](const std::string& other) { return other != option; });
    };
    addFrom({"quiet", "verbose"});
    for (const auto& group : table.exclusive) addFrom(group);
    return others;
}

std::string suggestionFor(const CommandTable& table, const std::string& name) {
    std::vector<std::string> names;
    for (const OptionEntry& option : allOptions(table)) names.push_back(option.name);
    const std::string nearest = nearestName(name, names);
    return nearest.empty() ? "'bandvox " + table.name + " --help' lists them all"
                           : "did you mean '--" + nearest + "'?";
}

std::vector<OptionEntry> groupedOptions(const CommandTable& table) {
    std::vector<OptionEntry> options = allOptions(table);
    for (auto begin = options.begin(); begin != options.end();) {
        begin = std::stable_partition(begin, options.end(), [group = begin->group](const auto& o) {
            return o.group == group;
        });
    }
    return options;
}

const std::vector<ExitStatus>& exitStatuses() {
    static const std::vector<ExitStatus> statuses{
        {0, "done; the output is complete and not empty"},
        {1, "failed while running (disk full, ...)"},
        {2, "wrong usage"},
        {3, "the input cannot be used (missing, malformed, wrong kind)"},
        {4, "the result would be empty or worse than the tolerance asked for"},
        {5, "not enough memory"},
        {130, "interrupted"},
    };
    return statuses;
}

std::string purposeText() {
    return "Turns shapes into band-limited OpenVDB volumes, and those into pictures.";
}

std::string outputText() {
    return "Nothing is written unless the status is 0, but for frames that are done.";
}

std::string helpText(const CommandTable& table) {
    std::string out = "Usage: bandvox " + table.name;
    for (const PositionalEntry& positional : table.positionals) {
        out += ' ' + positional.name + (positional.repeated ? "..." : "");
    }
    out += " [OPTION]...\n\n";
    appendWrapped(out, table.detail, 0);

    out += "\nArguments\n";
    for (const PositionalEntry& positional : table.positionals) {
        appendEntry(out, std::string(kTextIndent, ' ') + positional.name, positional.help);
    }
    std::string group;
    for (const OptionEntry& option : groupedOptions(table)) {
        if (option.group != group) {
            group = option.group;
            out += '\n' + group + '\n';
        }
        appendEntry(out, optionHead(option), optionHelp(option));
    }
    out += "\nExamples\n";
    for (const ExampleEntry& example : table.examples) {
        out += std::string(kTextIndent, ' ') + example.command + '\n' +
               std::string(2 * kTextIndent + 2, ' ');
        appendWrapped(out, example.help, 2 * kTextIndent + 2);
    }
    return out;
}

std::string overviewText(const std::vector<const CommandTable*>& tables) {
    std::string out =
        "Usage: bandvox COMMAND [ARGUMENT]... [OPTION]...\n\n" + purposeText() + "\n\nCommands\n";
    for (const CommandTable* table : tables) {
        appendEntry(out, std::string(kTextIndent, ' ') + table->name, table->summary);
    }
    appendEntry(out, "  help COMMAND", "Print all options of a command.");
    out += "\nExit status\n";
    for (const auto& [status, help] : exitStatuses()) {
        std::string line = "  " + std::to_string(status);
        line.resize(kStatusWidth, ' ');
        out += line + help + '\n';
    }
    out += outputText() + '\n';
    return out;
}

std::string nearestName(std::string_view name, const std::vector<std::string>& known) {
    std::string nearest;
    // A third of the letters may be wrong: more would suggest unrelated names.
    std::size_t limit = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : known) {
        const bool abbreviated = name.size() >= 2 && candidate.starts_with(name);
        const std::size_t distance = abbreviated ? 1 : editDistance(name, candidate);
        if (distance < limit) {
            limit = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace bandvox::app

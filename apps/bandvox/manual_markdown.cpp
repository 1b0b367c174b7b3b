// The directives are those of Sphinx's domain of programs, in the fences of MyST.

#include "manual_markdown.h"

#include <cctype>

namespace bandvox::app {
namespace {

/// Text that Markdown shows as it is, whatever stands in it: any ASCII punctuation may be escaped.
std::string markdown(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::ispunct(static_cast<unsigned char>(c))) out += '\\';
        out += c;
    }
    return out;
}

std::string heading(int level, const std::string& text) {
    std::string out(static_cast<std::size_t>(level), '#');
    out += ' ';
    out += markdown(text);
    out += "\n\n";
    return out;
}

std::string fenced(const std::string& language, const std::string& text) {
    std::string out = "```";
    out += language;
    out += '\n';
    out += text;
    out += "\n```\n\n";
    return out;
}

/// A term and, hanging in, what it is.
std::string defined(const std::string& term, const std::string& help) {
    std::string out = "`";
    out += term;
    out += "`\n: ";
    out += markdown(help);
    out += "\n\n";
    return out;
}

/// Options that follow are those of this program.
std::string programDirective(const std::string& command) {
    std::string out = "```{program} ";
    out += command;
    out += "\n```\n\n";
    return out;
}

std::string optionDirective(const OptionEntry& option) {
    std::string out = "````{option} ";
    if (option.letter) {
        out += '-';
        out += option.letter;
        out += ", ";
    }
    out += "--";
    out += option.name;
    if (!option.argument.empty()) {
        out += ' ';
        out += option.argument;
    }
    out += '\n';
    out += markdown(option.help);
    if (!option.standard.empty()) {
        out += " \\[";
        out += markdown(option.standard);
        out += "\\]";
    }
    out += "\n````\n\n";
    return out;
}

std::string optionSections(const std::vector<OptionEntry>& options) {
    std::string out, group;
    for (const OptionEntry& option : options) {
        if (option.group != group) out += heading(3, option.group);
        group = option.group;
        out += optionDirective(option);
    }
    return out;
}

std::string statusSections() {
    std::string out = heading(2, "Exit status");
    for (const auto& [status, help] : exitStatuses()) out += defined(std::to_string(status), help);
    out += markdown(outputText());
    out += '\n';
    return out;
}

std::string examplesOf(const CommandTable& table) {
    std::string out = heading(2, "Examples");
    for (const ExampleEntry& example : table.examples) {
        out += markdown(example.help);
        out += "\n\n";
        out += fenced("sh", example.command);
    }
    return out;
}

}  // namespace

std::string markdownPage(const CommandTable& table) {
    const std::string command = "bandvox " + table.name;
    std::string out = heading(1, command);
    out += programDirective(command);
    std::string line = command;
    for (const PositionalEntry& positional : table.positionals) {
        line += ' ';
        line += positional.name;
        if (positional.repeated) line += "...";
    }
    line += " [OPTION]...";
    out += fenced("text", line);
    out += markdown(table.detail);
    out += "\n\n";
    for (const PositionalEntry& positional : table.positionals) {
        out += defined(positional.name, positional.help);
    }
    out += examplesOf(table);
    out += heading(2, "Options");
    out += optionSections(groupedOptions(table));
    out += "How a command ends is told on the page of [bandvox](bandvox.md#exit-status).\n";
    return out;
}

std::string markdownOverview(const std::vector<const CommandTable*>& tables) {
    std::string out = heading(1, "bandvox");
    out += programDirective("bandvox");
    out += fenced("text", "bandvox COMMAND [ARGUMENT]... [OPTION]...");
    out += markdown(purposeText());
    out += "\n\n";
    out += heading(2, "Commands");
    for (const CommandTable* table : tables) {
        out += '[';
        out += table->name;
        out += "](bandvox-";
        out += table->name;
        out += ".md)\n: ";
        out += markdown(table->summary);
        out += "\n\n";
    }
    out += "`help COMMAND`\n: Print all options of a command\\.\n\n";
    out += heading(2, "Options of all commands");
    out += optionSections(sharedOptions());
    out += statusSections();
    return out;
}

}  // namespace bandvox::app

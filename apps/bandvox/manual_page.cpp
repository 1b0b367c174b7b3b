// The macros are those of man(7); the escapes those of groff_char(7).

#include "manual_page.h"

#include <bandvox/core/version.h>

#include <cstdint>
#include <cstdio>

namespace bandvox::app {
namespace {

/// The character that a UTF-8 sequence at `i` stands for; `i` goes to its last byte.
std::uint32_t codePointAt(const std::string& text, std::size_t& i) {
    const auto first = static_cast<unsigned char>(text[i]);
    const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
    std::uint32_t code = first & (0x3Fu >> more);
    for (int k = 0; k < more && i + 1 < text.size(); ++k) {
        code = code << 6 | (static_cast<unsigned char>(text[++i]) & 0x3Fu);
    }
    return code;
}

/// Text that roff prints as it is, whatever stands in it.
std::string roff(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool startsLine = i == 0 || text[i - 1] == '\n';
        if (static_cast<unsigned char>(c) >= 0x80) {
            char escape[16];
            std::snprintf(escape, sizeof escape, "\\[u%04X]", unsigned(codePointAt(text, i)));
            out += escape;
        } else if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else if (c == '\'') {
            out += "\\(aq";
        } else if (c == '`') {
            out += "\\(ga";
        } else if (c == '^') {
            out += "\\(ha";
        } else if (c == '~') {
            out += "\\(ti";
        } else if (c == '.' && startsLine) {
            out += "\\&.";
        } else {
            out += c;
        }
    }
    return out;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

/// A paragraph under a tag that hangs out.
std::string tagged(const std::string& tag, const std::string& help) {
    return ".TP\n" + tag + '\n' + roff(help) + '\n';
}

std::string nameOfPage(const std::string& command) {
    return command.empty() ? "bandvox" : "bandvox-" + command;
}

std::string headOfPage(const std::string& command, const std::string& summary) {
    std::string title;
    for (const char c : nameOfPage(command)) {
        title += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    std::string line = summary;
    if (line.ends_with('.') && !line.ends_with("..")) line.pop_back();
    std::string out = ".TH " + roff(title) + " 1 \"\" \"Bandvox ";
    out += version();
    // Examples have words of any length: nothing is spread out, and nothing is hyphenated.
    out += "\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\n";
    out += roff(nameOfPage(command)) + " \\- " + roff(line) + '\n';
    return out;
}

std::string optionTag(const OptionEntry& option) {
    std::string tag;
    if (option.letter) tag = bold(std::string{'-', option.letter}) + ", ";
    tag += bold("--" + option.name);
    if (!option.argument.empty()) tag += ' ' + italic(option.argument);
    return tag;
}

std::string optionText(const OptionEntry& option) {
    return option.standard.empty() ? option.help : option.help + " [" + option.standard + "]";
}

std::string optionSection(const std::vector<OptionEntry>& options) {
    std::string out = ".SH OPTIONS\n";
    std::string group;
    for (const OptionEntry& option : options) {
        if (option.group != group) out += ".SS " + roff(option.group) + '\n';
        group = option.group;
        out += tagged(optionTag(option), optionText(option));
    }
    return out;
}

std::string statusSection() {
    std::string out = ".SH EXIT STATUS\n";
    for (const auto& [status, help] : exitStatuses()) {
        out += tagged(bold(std::to_string(status)), help);
    }
    return out + ".PP\n" + roff(outputText()) + '\n';
}

std::string exampleSection(const std::vector<ExampleEntry>& examples) {
    std::string out = ".SH EXAMPLES\n";
    for (const ExampleEntry& example : examples) out += tagged(bold(example.command), example.help);
    return out;
}

std::string reference(const std::string& command) {
    return bold(nameOfPage(command)) + "(1)";
}

}  // namespace

std::string manualPage(const CommandTable& table, const std::vector<const CommandTable*>& others) {
    std::string out = headOfPage(table.name, table.summary);
    out += ".SH SYNOPSIS\n" + bold("bandvox " + table.name);
    for (const PositionalEntry& positional : table.positionals) {
        out += ' ' + italic(positional.name) + (positional.repeated ? "..." : "");
    }
    out += " [" + italic("OPTION") + "]...\n";
    out += ".SH DESCRIPTION\n" + roff(table.detail) + '\n';
    out += ".SH ARGUMENTS\n";
    for (const PositionalEntry& positional : table.positionals) {
        out += tagged(italic(positional.name), positional.help);
    }
    out += optionSection(groupedOptions(table));
    out += statusSection();
    out += exampleSection(table.examples);
    out += ".SH SEE ALSO\n" + reference("");
    for (const CommandTable* other : others) {
        if (other->name != table.name) out += ",\n" + reference(other->name);
    }
    return out + '\n';
}

std::string overviewPage(const std::vector<const CommandTable*>& tables) {
    std::string out = headOfPage("", purposeText());
    out += ".SH SYNOPSIS\n" + bold("bandvox") + ' ' + italic("COMMAND") + " [" +
           italic("ARGUMENT") + "]... [" + italic("OPTION") + "]...\n";
    out += ".SH DESCRIPTION\n" + roff(purposeText()) +
           "\nEach command has a page of its own, and says the same with " + bold("--help") +
           ".\n.SH COMMANDS\n";
    std::vector<ExampleEntry> examples;
    std::string see = ".SH SEE ALSO\n";
    for (const CommandTable* table : tables) {
        out += tagged(bold(table->name), table->summary);
        if (!table->examples.empty()) examples.push_back(table->examples.front());
        if (table != tables.front()) see += ",\n";
        see += reference(table->name);
    }
    out += tagged(bold("help") + ' ' + italic("COMMAND"), "Print all options of a command.");
    out += optionSection(sharedOptions());
    out += statusSection();
    out += exampleSection(examples);
    return out + see + '\n';
}

}  // namespace bandvox::app

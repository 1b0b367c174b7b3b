#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bandvox::app {

/// What a value may be, as far as that can be listed: for whatever completes command lines.
struct ValueHint {
    std::vector<std::string> words = {};    ///< the words to choose from
    std::vector<std::string> endings = {};  ///< of files, lower case with the dot
    bool isList = false;                    ///< several of the words, separated by commas
    bool isFolder = false;                  ///< a folder will do, too
};

/// One option of a command, in words. Help, parser, and whatever else tells users about options
/// are made from it.
struct OptionEntry {
    std::string name;      ///< long name, without the dashes
    char letter = 0;       ///< short name; 0 for none
    std::string argument;  ///< what its value is called; empty for a flag
    std::string standard;  ///< what holds if it is not given; empty for a flag or a required one
    std::string help;      ///< one or two sentences
    std::string group;     ///< the heading it stands under
    ValueHint hint = {};
};

/// One argument that stands without a name.
struct PositionalEntry {
    std::string name;  ///< as the help shows it
    std::string help;
    bool repeated = false;  ///< there may be more of it; of the last one
    ValueHint hint = {};
};

/// A command line that works, and what it does.
struct ExampleEntry {
    std::string command;
    std::string help;
};

/// All that is said about a command.
struct CommandTable {
    std::string name;
    std::string summary;                       ///< half a line, for the list of commands
    std::string detail;                        ///< a few sentences
    std::vector<PositionalEntry> positionals;  ///< each of them at least once
    std::vector<OptionEntry> options;          ///< its own, without the shared ones
    std::vector<ExampleEntry> examples;
    /// Groups of options of which one rules the others out: given on the command line, it puts
    /// aside those that a file of options gives.
    std::vector<std::vector<std::string>> exclusive = {};
};

/// The options that `option` rules out, as the table's groups and those of the shared options say.
std::vector<std::string> ruledOut(const CommandTable& table, const std::string& option);

/// The entry of an option by its name, or null.
const OptionEntry* findOption(const CommandTable& table, const std::string& name);

/// The options that every command takes.
const std::vector<OptionEntry>& sharedOptions();

/// A command's own options followed by the shared ones.
std::vector<OptionEntry> allOptions(const CommandTable& table);

/// The same, those of a group together, in the order in which both come first.
std::vector<OptionEntry> groupedOptions(const CommandTable& table);

/// A status with which the command ends, and what it means.
struct ExitStatus {
    int status;
    std::string help;
};

/// All of them.
const std::vector<ExitStatus>& exitStatuses();

/// What bandvox is for, and what holds for the outputs of all commands: a sentence each.
std::string purposeText();
std::string outputText();

/// What to say of a name that no option has: "; did you mean ...?", or where they are listed.
std::string suggestionFor(const CommandTable& table, const std::string& name);

/// What `bandvox COMMAND --help` prints.
std::string helpText(const CommandTable& table);

/// What `bandvox --help` prints.
std::string overviewText(const std::vector<const CommandTable*>& tables);

/// The known name that `name` is most likely a slip of, or an empty string if none is near.
std::string nearestName(std::string_view name, const std::vector<std::string>& known);

}  // namespace bandvox::app

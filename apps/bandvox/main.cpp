// The bandvox command: finds the command that is asked for, and turns exceptions into messages
// and exit statuses.

#include "command_line.h"
#include "command_run.h"
#include "commands.h"
#include "frame_pattern.h"
#include "interrupt.h"
#include "words.h"
#include "write_manual.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

namespace bandvox::app {
namespace {

constexpr int kSignalStatus = 128;  // a shell's exit status for signal s is 128 + s

std::vector<const CommandTable*> commandTables() {
    std::vector<const CommandTable*> tables;
    for (const Command& command : commands()) tables.push_back(&command.table());
    return tables;
}

const Command& findCommand(const std::string& name) {
    std::vector<std::string> names;
    for (const Command& command : commands()) {
        if (command.table().name == name) return command;
        names.push_back(command.table().name);
    }
    names.emplace_back("help");
    const std::string nearest = nearestName(name, names);
    throw Error(
        ErrorKind::Usage,
        (name.starts_with('-') ? "unknown option '" : "unknown command '") + name + "'; " +
            (nearest.empty() || name.starts_with('-') ? "'bandvox --help' lists the commands"
                                                      : "did you mean '" + nearest + "'?"));
}

void printHelp(const std::vector<std::string>& commandNames) {
    if (commandNames.size() > 1) {
        throw Error(ErrorKind::Usage, "'help' takes one command; found '" + commandNames[1] +
                                          "' after '" + commandNames[0] + "'");
    }
    if (commandNames.empty() || commandNames.front() == "help") {
        writeResult(overviewText(commandTables()));
    } else {
        writeResult(helpText(findCommand(commandNames.front()).table()));
    }
}

void printVersion() {
    writeResult(std::string("bandvox ") + version() + "\n");
}

// Runs a command. What the library finds wrong with its one input names that.
void runNamed(const Command& command, const CommandLine& line) {
    try {
        command.run(line);
    } catch (const Error& error) {
        const std::string message = error.what();
        const std::vector<std::string>& inputs = line.positionals();
        const bool isNamed = error.kind() != ErrorKind::Input || inputs.size() != 1 ||
                             hasFrame(inputs.front()) ||
                             message.find(inputs.front()) != std::string::npos;
        if (isNamed) throw;
        throw Error(error.kind(), inputs.front() + ": " + message);
    }
}

void runCommand(const std::vector<std::string>& arguments) {
    if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
        return printHelp({});
    }
    const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
    if (arguments[0] == "--version") return printVersion();
    if (arguments[0] == "help") return printHelp(rest);
    // For the build alone, and so in no help.
    if (arguments[0] == "--write-manual" && rest.size() == 1) {
        return writeManual(rest.front(), commandTables());
    }

    const Command& command = findCommand(arguments[0]);
    const CommandLine line(command.table(), rest);
    if (line.has("help")) return printHelp({command.table().name});
    if (line.has("version")) return printVersion();
    line.requirePositionals();
    runNamed(command, line);
}

int fail(const std::string& message, int status) {
    // An error is one line, whatever a library has put into its message.
    std::string oneLine = message;
    std::replace(oneLine.begin(), oneLine.end(), '\n', ' ');
    while (oneLine.ends_with(' ')) oneLine.pop_back();
    std::fprintf(stderr, "bandvox: error: %s\n", printable(oneLine).c_str());
    return status;
}

int statusOf(const Error& error) {
    if (error.kind() != ErrorKind::Interrupted || interruptSignal() == 0) {
        return error.exitStatus();
    }
    return kSignalStatus + interruptSignal();
}

int runBandvox(const std::vector<std::string>& arguments) {
    try {
        runCommand(arguments);
        return 0;
    } catch (const Error& error) {
        return fail(error.what(), statusOf(error));
    } catch (const std::bad_alloc&) {
        return fail("not enough memory", static_cast<int>(ErrorKind::Memory));
    } catch (const std::exception& error) {
        return fail(error.what(), static_cast<int>(ErrorKind::Runtime));
    }
}

}  // namespace
}  // namespace bandvox::app

int main(int argc, char** argv) {
    bandvox::app::installSignalHandlers();
    return bandvox::app::runBandvox({argv + std::min(argc, 1), argv + argc});
}

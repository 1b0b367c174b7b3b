#pragma once

#include "option_table.h"

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app {

/// A line of a file of options.
struct ConfigEntry {
    std::string name;
    std::string value;   ///< "true" or "false" of a flag
    std::string origin;  ///< "FILE:LINE"
};

/// Reads a file of options for a command: lines `name = value`, `#` at the start of a line or after
/// a space begins a comment, flags are true or false. Throws Error(ErrorKind::Usage), which names
/// file and line, for what is no such line, names that the command does not have or that stand
/// there twice, flags that are neither, and for the options config, help and version;
/// Error(ErrorKind::Input) if the file cannot be read.
std::vector<ConfigEntry> readConfigFile(const std::filesystem::path& path,
                                        const CommandTable& table);

/// Text without the white space around it.
std::string trimmed(const std::string& text);

}  // namespace bandvox::app

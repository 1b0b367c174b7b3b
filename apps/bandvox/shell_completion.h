#pragma once

#include "option_table.h"

#include <string>
#include <vector>

// Scripts by which shells complete command lines, of the same tables as the help: commands,
// options, the words that an option takes, and files by their endings.
namespace bandvox::app {

/// For bash, with the functions of bash-completion 2.
std::string bashCompletion(const std::vector<const CommandTable*>& tables);

/// For zsh: the file _bandvox of a folder in fpath.
std::string zshCompletion(const std::vector<const CommandTable*>& tables);

/// For fish 3.
std::string fishCompletion(const std::vector<const CommandTable*>& tables);

/// The first sentence of a help, at most some 70 characters of it, without the full stop.
std::string shortHelp(const std::string& help);

/// Text in single quotes, as all three shells take it: `quote` is what stands for one inside.
std::string singleQuoted(const std::string& text, const std::string& quote);

/// True if an option's value is a file, of any ending if none are listed.
bool takesFile(const OptionEntry& option);

}  // namespace bandvox::app

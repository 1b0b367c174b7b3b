#pragma once

#include "option_table.h"

#include <string>
#include <vector>

// Pages of the manual's site, of the same tables as the help: Markdown with directives of Sphinx.
namespace bandvox::app {

/// The page of a command.
std::string markdownPage(const CommandTable& table);

/// The page of bandvox itself: the commands, the options that all of them take, the exit statuses.
std::string markdownOverview(const std::vector<const CommandTable*>& tables);

}  // namespace bandvox::app

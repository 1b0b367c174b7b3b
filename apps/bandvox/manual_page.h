#pragma once

#include "option_table.h"

#include <string>
#include <vector>

// Pages for man(1), of the same tables as the help.
namespace bandvox::app {

/// The source of the page bandvox-COMMAND(1). `others`: the tables of all commands, to refer to.
std::string manualPage(const CommandTable& table, const std::vector<const CommandTable*>& others);

/// The source of the page bandvox(1).
std::string overviewPage(const std::vector<const CommandTable*>& tables);

}  // namespace bandvox::app

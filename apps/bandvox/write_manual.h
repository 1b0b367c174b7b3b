#pragma once

#include "option_table.h"

#include <filesystem>
#include <vector>

namespace bandvox::app {

/// Writes what is made of the commands' tables: man/bandvox.1 and man/bandvox-COMMAND.1,
/// bash/bandvox, zsh/_bandvox and fish/bandvox.fish, which are installed, and markdown/bandvox.md
/// and markdown/bandvox-COMMAND.md, pages of the manual's site; under `folder`, whose missing
/// folders are made. Throws Error(ErrorKind::Runtime) if that fails.
void writeManual(const std::filesystem::path& folder,
                 const std::vector<const CommandTable*>& tables);

}  // namespace bandvox::app

#pragma once

#include "option_table.h"

#include <filesystem>
#include <vector>

namespace bandvox::app {

/// Writes what is installed beside the command and made of its tables: man/bandvox.1 and
/// man/bandvox-COMMAND.1, bash/bandvox, zsh/_bandvox and fish/bandvox.fish, under `folder`, whose
/// missing folders are made. Throws Error(ErrorKind::Runtime) if that fails.
void writeManual(const std::filesystem::path& folder,
                 const std::vector<const CommandTable*>& tables);

}  // namespace bandvox::app

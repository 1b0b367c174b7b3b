#pragma once

#include <string>

namespace bandvox::app {

/// Throws Error(ErrorKind::Input), which says that one cannot `verb` it and how to make a .vdb file
/// of it if that is possible, unless `input` is named like a .vdb file.
void requireVdb(const std::string& verb, const std::string& input);

}  // namespace bandvox::app

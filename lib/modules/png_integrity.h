#pragma once

#include <istream>

namespace bandvox {

/// True if it begins as a PNG file does, whatever its name is. Goes back to the beginning.
bool isPng(std::istream& stream);

/// Checks that the chunks of a PNG file of so many bytes lie within it: memory is taken for them
/// before they are read. Throws Error(ErrorKind::Input), which does not name the file.
void requireSoundPng(std::istream& stream, double length);

}  // namespace bandvox

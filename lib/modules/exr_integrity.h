#pragma once

#include <istream>

namespace bandvox {

/// True if it begins as an OpenEXR file does, whatever its name is. Goes back to the beginning.
bool isExr(std::istream& stream);

/// Checks the headers of an OpenEXR file of so many bytes, as far as the libraries that read them
/// trust in them: that attributes lie within the file, that channels are of known types, that the
/// tables and pixels they tell of can be there. Throws Error(ErrorKind::Input), which does not name
/// the file.
void requireSoundExr(std::istream& stream, double length);

}  // namespace bandvox

#pragma once

#include "source/file_integrity.h"

namespace bandvox {

/// Complains about a STEP, IGES or BREP file, as text, that is cut short, or damaged in a way that
/// Open CASCADE does not survive or takes for good.
void requireSoundCadFile(const FileContents& file);

}  // namespace bandvox

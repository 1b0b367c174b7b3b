#pragma once

#include "source/cad_shape.h"

#include <filesystem>
#include <functional>

namespace bandvox {

/// Throws Error(ErrorKind::Interrupted) if the user has asked to stop. A module cannot ask itself:
/// of a library that Python has loaded it sees no functions.
using InterruptCheck = std::function<void()>;

/// Reads STEP, IGES and BREP files with Open CASCADE, whose libraries take longer to load than many
/// a drawing: so it lies in a module that is loaded when it is first needed.
class CadLibrary {
  public:
    virtual ~CadLibrary() = default;

    /// Lengths are millimetres, but for .brep, which has no unit. `path` ends in .step, .stp,
    /// .iges, .igs or .brep. Throws Error(ErrorKind::Input), which does not name the file, and
    /// Error(ErrorKind::Interrupted).
    virtual CadShape read(const std::filesystem::path& path, const InterruptCheck& check) const = 0;
};

/// Throws Error(ErrorKind::Input) if the library was built without it, and
/// Error(ErrorKind::Runtime) if the module cannot be loaded.
const CadLibrary& cadLibrary();

}  // namespace bandvox

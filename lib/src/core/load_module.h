#pragma once

namespace bandvox {

/// Loads a module that lies beside this library, or else wherever the loader looks for it, and
/// asks its function `entry`, which takes nothing, for what it offers. Throws
/// Error(ErrorKind::Runtime), which begins with `failure`, if there is none.
const void* loadModule(const char* file, const char* entry, const char* failure);

}  // namespace bandvox

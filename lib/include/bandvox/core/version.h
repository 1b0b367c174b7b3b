#pragma once

namespace bandvox {

/// The library's version, "major.minor.patch".
const char* version();

}  // namespace bandvox

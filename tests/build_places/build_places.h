#pragma once

// Where this build is. One file tells it, so that all others are the same for the compiler, and for
// its cache, wherever they are built.
namespace bandvox::build_places {

/// The folder of the sources.
const char* sources();
/// The command that was built.
const char* command();
/// Examples; empty if they were not built.
const char* paperFigures();
const char* shapeToScreen();

}  // namespace bandvox::build_places

#pragma once

#include <string>
#include <vector>

// How the files end that commands take and write, lower case with the dot: for the hints of their
// tables.
namespace bandvox::app {

/// Of grids and meshes that can be read.
std::vector<std::string> vdbAndMeshEndings();

/// Of all that convert takes.
std::vector<std::string> convertibleEndings();

/// Of all that convert writes.
std::vector<std::string> convertedEndings();

/// The built-in shapes as they are given on the command line.
std::vector<std::string> shapeWords();

}  // namespace bandvox::app

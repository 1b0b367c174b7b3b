#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app {

/// The files that an input consists of, the one that is named first: with an .obj file whose
/// colours are wanted its materials and their textures, with a .gltf file its buffers and images,
/// with an .nhdr or .mhd file its values, with a folder all files in it, in the order of their
/// names, with a name that has a place for a number all that are there. Files that are missing are
/// left away, which whoever reads the input will say. Empty for built-in shapes and the standard
/// input.
std::vector<std::filesystem::path> filesOfInput(const std::string& input, bool wantsColors);

}  // namespace bandvox::app

#pragma once

#include <filesystem>
#include <string>
#include <vector>

// How notes stand in mesh files.
namespace bandvox {

/// What stands before a note, in a line after another one.
inline const std::string kObjNote = "\n# note: ";
inline const std::string kPlyNote = "\ncomment note: ";

/// The first megabyte of a mesh file: notes stand there. Empty if it cannot be read.
std::string headOfMeshFile(const std::filesystem::path& path);

/// Members that follow others of the asset of a glTF file; empty without notes.
std::string gltfNotes(const std::vector<std::string>& notes);

}  // namespace bandvox

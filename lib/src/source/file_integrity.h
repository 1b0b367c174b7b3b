#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// A file in memory, and how to complain about it.
struct FileContents {
    std::filesystem::path path;
    std::string bytes;

    /// Throws Error(ErrorKind::Input): the file, what was found in it, and what was expected.
    [[noreturn]] void fail(const std::string& what) const;
};

/// Reads a whole file. Throws Error(ErrorKind::Input) if it cannot be read.
FileContents readFile(const std::filesystem::path& path);

/// What is known of a mesh file before the importer has read it.
struct MeshFileFacts {
    std::vector<std::string> warnings;
    std::size_t triangles = 0;  ///< of a glTF file; the importer silently leaves out those with
                                ///< bad indices
};

/// Checks that a mesh file is complete, that its faces refer to points it has, and that it is not
/// nested too deeply, as far as the importer does not: that one takes several kinds of damaged
/// file for good, and others crash it.
///
/// `extension` is in lower case with its dot. Throws Error(ErrorKind::Input).
MeshFileFacts checkMeshFile(const std::filesystem::path& path, std::string_view extension);

void checkObj(const FileContents& file, std::vector<std::string>& warnings);
void checkOff(const FileContents& file, std::vector<std::string>& warnings);
void checkPly(const FileContents& file, std::vector<std::string>& warnings);
void checkStl(const FileContents& file);
void checkGlb(const FileContents& file);
void checkCollada(const FileContents& file);

/// Checks the JSON of a glTF file, text or binary. Returns how many triangles it says that it has,
/// in all its meshes; 0 if it is not of version 2.
std::size_t checkGltf(const FileContents& file);

}  // namespace bandvox

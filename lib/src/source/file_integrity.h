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

/// Checks that a mesh file is complete and that its faces refer to points it has, as far as the
/// importer does not: that one takes several kinds of damaged file for good.
///
/// `extension` is in lower case with its dot; formats without a check pass. Returns warnings.
/// Throws Error(ErrorKind::Input).
std::vector<std::string> checkMeshFile(const std::filesystem::path& path,
                                       std::string_view extension);

void checkObj(const FileContents& file, std::vector<std::string>& warnings);
void checkOff(const FileContents& file, std::vector<std::string>& warnings);
void checkPly(const FileContents& file, std::vector<std::string>& warnings);
void checkStl(const FileContents& file);
void checkGlb(const FileContents& file);

/// How many triangles a glTF file (text or binary) says that it has, in all its meshes; 0 if it
/// is not valid JSON of version 2. The importer silently leaves out those with bad indices.
std::size_t countGltfTriangles(const FileContents& file);

}  // namespace bandvox

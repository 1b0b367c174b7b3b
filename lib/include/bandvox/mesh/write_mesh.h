#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

class AtomicFile;

/// Extensions that writeMesh takes, lower case with the dot: .obj .ply .stl .gltf .glb.
const std::vector<std::string>& writableMeshExtensions();

/// True if the path ends like a mesh file that can be written, upper or lower case.
bool isWritableMesh(const std::filesystem::path& path);

/// True if that kind of file has colours of points.
bool holdsColors(const std::filesystem::path& path);

/// True if that kind of file has room for notes.
bool holdsNotes(const std::filesystem::path& path);

/// The notes in a mesh file that writeMesh has written; none of other files, and of those that
/// cannot be read.
std::vector<std::string> readMeshNotes(const std::filesystem::path& path);

/// True if a file with notes is as writeMesh has left it, byte for byte, by the checksum that it
/// stores with them; false of files without. Throws Error(ErrorKind::Interrupted).
bool isAsWritten(const std::filesystem::path& path, Progress& progress = silentProgress());

/// Writes a mesh as the extension of the file's target says; the caller commits it. Written in one
/// go from start to end.
///
/// .ply: binary, little-endian; colours sRGB in 8 bits. .stl: binary, without normals of points
/// and colours. .obj: text, colours sRGB after the coordinates. .glb and .gltf: glTF 2.0 in a
/// single file, colours linear (docs/mesh-output.md). Coordinates are stored in single precision,
/// or in double by .ply and .obj if they are far from the origin. Throws Error(ErrorKind::Usage)
/// for another extension, and for a mesh that has no triangles, an index out of range, or too few
/// or too many normals or colours; Error(ErrorKind::Result) for one that the format cannot hold;
/// Error(ErrorKind::Runtime) if the file cannot be written.
void writeMesh(AtomicFile& file, const SurfaceMesh& mesh, Progress& progress = silentProgress());

/// The same to a path, and commits it.
void writeMesh(const std::filesystem::path& path, const SurfaceMesh& mesh);

}  // namespace bandvox

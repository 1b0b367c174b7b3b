#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// A mesh as its file has it, before any repair.
struct MeshFile {
    Mesh mesh;                          ///< polygons triangulated, node transforms applied
    std::size_t objects = 0;            ///< meshes in the file, instances counted each
    std::vector<std::string> warnings;  ///< what looks wrong but could be read
};

/// Extensions that readMesh takes, lower case with the dot.
const std::vector<std::string>& meshExtensions();

/// True if the path ends like a mesh file, upper or lower case.
bool isMeshFile(const std::filesystem::path& path);

/// Reads a polygon mesh (obj, ply, stl, off, gltf, glb, fbx, dae). All objects of the file come
/// together, each under its node's transform.
/// Throws Error(ErrorKind::Input), naming the file and what is wrong, if it is missing, a
/// folder, empty, of an unknown kind, malformed or cut short, has no faces, or has a coordinate
/// that is not finite.
MeshFile readMesh(const std::filesystem::path& path, Progress& progress = silentProgress());

}  // namespace bandvox

#include "core/letter_case.h"
#include "source/mesh_import.h"

#include <bandvox/source/read_mesh.h>

#include <algorithm>

namespace bandvox {

const std::vector<std::string>& meshExtensions() {
    static const std::vector<std::string> extensions = {".obj",  ".ply", ".stl", ".off",
                                                        ".gltf", ".glb", ".fbx", ".dae"};
    return extensions;
}

bool isMeshFile(const std::filesystem::path& path) {
    const auto& known = meshExtensions();
    return std::find(known.begin(), known.end(), lowerExtension(path)) != known.end();
}

MeshFile readMesh(const std::filesystem::path& path, Progress& progress) {
    return MeshImport(path, progress).file();
}

}  // namespace bandvox

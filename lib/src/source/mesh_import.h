#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/read_mesh.h>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

/// A mesh of a scene at one of the places where nodes put it.
struct MeshInstance {
    using Transform = aiMatrix4x4t<double>;
    const aiMesh* mesh;
    Transform transform;
};

/// Calls visit(corners) for each triangle, corners as indices into the mesh's points and
/// counter-clockwise from outside.
template <typename Visitor>
void forEachTriangle(const MeshInstance& instance, const Visitor& visit) {
    // A reflection exchanges the sides of a face.
    const bool reflects = instance.transform.Determinant() < 0.0;
    for (unsigned i = 0; i < instance.mesh->mNumFaces; ++i) {
        const aiFace& face = instance.mesh->mFaces[i];
        if (face.mNumIndices != 3) continue;
        openvdb::Vec3I corners(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
        if (reflects) std::swap(corners[1], corners[2]);
        visit(corners);
    }
}

/// A mesh file as the importer holds it, checked and split into triangles.
class MeshImport {
  public:
    /// Throws as readMesh does.
    MeshImport(const std::filesystem::path& path, Progress& progress);

    const aiScene& scene() const { return *mImporter.GetScene(); }

    /// Every mesh of every node, each as often as nodes refer to it.
    std::vector<MeshInstance> instances() const;

    /// All instances as one mesh: their points one after another, and their triangles in the order
    /// of forEachTriangle. Throws as readMesh does.
    MeshFile file() const;

  private:
    void read(Progress& progress, std::size_t triangles);

    std::filesystem::path mPath;
    Assimp::Importer mImporter;
    std::vector<std::string> mWarnings;
};

}  // namespace bandvox

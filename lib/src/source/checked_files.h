#pragma once

#include "source/file_integrity.h"

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <set>
#include <string>

namespace bandvox {

/// The files that the importer opens: the mesh file, and those that it refers to. They have to be
/// regular files, and those of which damage would crash the importer are checked.
class CheckedFiles final : public Assimp::DefaultIOSystem {
  public:
    /// What the file at `mesh` refers to are materials if it is an .obj.
    CheckedFiles(const std::filesystem::path& mesh, bool isObj)
        : mMesh(mesh.string()), mIsObj(isObj) {}

    /// Throws Error(ErrorKind::Input), which the importer takes for its own: it then fails with
    /// that text.
    Assimp::IOStream* Open(const char* path, const char* mode) override;

  private:
    std::string mMesh;
    bool mIsObj;
    std::set<std::string> mChecked;  // materials
};

/// Checks the materials of an .obj file: the importer puts a texture, or an anisotropy, that stands
/// before the first material into one that is not there. Throws Error(ErrorKind::Input).
void checkMaterials(const FileContents& file);

/// Has the importer read them in a copy of the process, for all that the check does not know.
/// Throws Error(ErrorKind::Input) if it does not survive that; what it refuses it will refuse
/// again.
void tryMaterials(const FileContents& file);

}  // namespace bandvox

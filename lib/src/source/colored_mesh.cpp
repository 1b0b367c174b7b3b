#include "core/words.h"
#include "source/mesh_import.h"
#include "source/mesh_materials.h"

#include <bandvox/core/error.h>
#include <bandvox/source/colored_mesh.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failColors(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::Input, "\"" + path.string() + "\" " + what);
}

void requireFinite(bool isFinite, const char* what, unsigned point, const aiMesh& mesh,
                   const fs::path& path) {
    if (isFinite) return;
    failColors(path, std::string("has a ") + what + " that is not finite, at point " +
                         std::to_string(point) + " of object " + mesh.mName.C_Str());
}

/// Whole numbers of which some are above 1 are taken to count to 255, as some programs write them.
float scaleOf(const aiMesh& mesh, const ColorConvention& convention) {
    if (convention.isGltf) return 1;
    float highest = 0;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiColor4D& c = mesh.mColors[0][i];
        for (const float value : {c.r, c.g, c.b}) {
            if (value != std::floor(value)) return 1;
            highest = std::max(highest, value);
        }
    }
    return highest > 1 ? 1.0F / 255 : 1;
}

/// The colours of a mesh's points, in linear light; empty if it has none.
std::vector<openvdb::Vec3f> pointColors(const aiMesh& mesh, const ColorConvention& convention,
                                        const fs::path& path) {
    std::vector<openvdb::Vec3f> colors;
    if (!mesh.HasVertexColors(0)) return colors;
    const float scale = scaleOf(mesh, convention);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiColor4D& c = mesh.mColors[0][i];
        requireFinite(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b), "colour", i,
                      mesh, path);
        colors.push_back(convention.linear(scale * c.r, scale * c.g, scale * c.b));
    }
    return colors;
}

/// The places of a mesh's points on a material's texture.
std::vector<openvdb::Vec2f> pointCoordinates(const aiMesh& mesh, const MaterialColor& material,
                                             const fs::path& path) {
    std::vector<openvdb::Vec2f> coordinates;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& uvw = mesh.mTextureCoords[material.uvChannel][i];
        const aiVector3D uv = material.uvTransform * aiVector3D(uvw.x, uvw.y, 1);
        requireFinite(std::isfinite(uv.x) && std::isfinite(uv.y), "texture coordinate", i, mesh,
                      path);
        coordinates.emplace_back(uv.x, uv.y);
    }
    return coordinates;
}

/// Paints the triangles of a file's objects, one after another.
class Painter {
  public:
    Painter(const MeshImport& import, const fs::path& path, ColoredMeshFile& file)
        : mPath(path), mMaterials(import.scene(), path), mFile(file) {
        mRead.resize(import.scene().mNumMaterials);
        mIsRead.resize(mRead.size());
    }

    void paint(const MeshInstance& instance);

    /// Settles what the colours of all objects together say.
    void finish();

  private:
    MaterialColor materialOf(const aiMesh& mesh);

    const fs::path& mPath;
    MaterialReader mMaterials;
    ColoredMeshFile& mFile;
    std::vector<MaterialColor> mRead;
    std::vector<bool> mIsRead;
    std::size_t mGuessed = 0;
};

MaterialColor Painter::materialOf(const aiMesh& mesh) {
    const unsigned index = mesh.mMaterialIndex;
    if (index >= mRead.size()) return {};
    if (!mIsRead[index]) {
        mRead[index] = mMaterials.read(index);
        mIsRead[index] = true;
    }
    MaterialColor material = mRead[index];
    if (material.texture >= 0 && !mesh.HasTextureCoords(material.uvChannel)) {
        mFile.warnings.push_back(std::string("object ") + mesh.mName.C_Str() +
                                 " has a texture, but no texture coordinates of set " +
                                 std::to_string(material.uvChannel) +
                                 "; the material's colour stands for it");
        material.texture = TrianglePaint::kNoTexture;
    }
    return material;
}

void Painter::paint(const MeshInstance& instance) {
    const aiMesh& mesh = *instance.mesh;
    const ColorConvention& convention = mMaterials.convention();
    const std::vector<openvdb::Vec3f> colors = pointColors(mesh, convention, mPath);
    // Only glTF has colours of points and of a material for the same triangle.
    const bool usesMaterial = colors.empty() || convention.isGltf;
    const MaterialColor material = usesMaterial ? materialOf(mesh) : MaterialColor();
    const bool isKnown = !colors.empty() || material.kind == MaterialColor::Kind::Known;
    const bool isTextured = usesMaterial && material.texture >= 0;
    std::vector<openvdb::Vec2f> coordinates;
    if (isTextured) coordinates = pointCoordinates(mesh, material, mPath);
    forEachTriangle(instance, [&](const openvdb::Vec3I& corners) {
        TrianglePaint& paint = mFile.colored.paints.emplace_back();
        for (int k = 0; k < 3; ++k) {
            paint.color[k] = material.factor;
            if (!colors.empty()) paint.color[k] *= colors[corners[k]];
            if (isTextured) paint.uv[k] = coordinates[corners[k]];
        }
        if (isKnown || material.kind == MaterialColor::Kind::Guessed) {
            paint.texture = isTextured ? material.texture : TrianglePaint::kNoTexture;
            ++mFile.triangles;
        }
        if (!isKnown && material.kind == MaterialColor::Kind::Guessed) ++mGuessed;
    });
}

void Painter::finish() {
    mFile.warnings.insert(mFile.warnings.end(), mMaterials.warnings.begin(),
                          mMaterials.warnings.end());
    const std::size_t all = mFile.colored.paints.size();
    // One grey for all is what the importer says of a file without colours.
    if (mFile.triangles == mGuessed) {
        failColors(mPath,
                   "has no colours: its points have none, and no material with a colour or a "
                   "texture is found; expected one of these");
    }
    if (mFile.triangles < all) {
        mFile.warnings.push_back(std::to_string(all - mFile.triangles) + " of " +
                                 std::to_string(all) + " triangles have no colour");
    }
    mFile.colored.textures = std::move(mMaterials.textures);
}

}  // namespace

ColoredMeshFile readColoredMesh(const fs::path& path, Progress& progress) {
    const MeshImport import(path, progress);
    MeshFile plain = import.file();
    ColoredMeshFile file;
    file.colored.name = path.filename().string();
    file.colored.mesh = std::move(plain.mesh);
    file.objects = plain.objects;
    file.warnings = std::move(plain.warnings);
    file.colored.paints.reserve(file.colored.mesh.triangles.size());
    const ProgressStage stage(progress, "read colours", 0);
    Painter painter(import, path, file);
    for (const MeshInstance& instance : import.instances()) {
        progress.throwIfInterrupted();
        painter.paint(instance);
    }
    painter.finish();
    return file;
}

}  // namespace bandvox

#include "core/words.h"
#include "source/file_integrity.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_mesh.h>

#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using Matrix = aiMatrix4x4t<double>;

/// Steps that the importer's progress is told in.
constexpr int kSteps = 100;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::Input, "\"" + path.string() + "\" " + what);
}

std::string lowerExtension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// Checks what can be said of a file from outside.
void checkFile(const fs::path& path) {
    std::error_code status;
    const fs::file_type type = fs::status(path, status).type();
    if (type == fs::file_type::not_found) fail(path, "does not exist; expected a mesh file");
    if (type == fs::file_type::directory) fail(path, "is a folder; expected a mesh file");
    if (type != fs::file_type::regular) fail(path, "is not a regular file; expected a mesh file");
    if (!isMeshFile(path)) {
        std::string known;
        for (const std::string& extension : meshExtensions()) {
            known += (known.empty() ? "" : " ") + extension;
        }
        fail(path, "is of an unknown kind; expected one of " + known);
    }
    if (fs::file_size(path, status) == 0 && !status) fail(path, "is empty; expected a mesh");
}

/// Passes the importer's progress on, and the caller's wish to stop to the importer.
class ImportProgress final : public Assimp::ProgressHandler {
  public:
    explicit ImportProgress(Progress& progress) : mProgress(progress) {}

    bool Update(float fraction) override {
        // It is negative where the importer does not know.
        const int steps = std::clamp(static_cast<int>(fraction * kSteps), 0, kSteps);
        if (steps > mSteps) mProgress.advance(steps - std::exchange(mSteps, steps));
        return !mProgress.interrupted();
    }

  private:
    Progress& mProgress;
    int mSteps = 0;
};

std::string nameOf(const aiScene& scene, unsigned mesh) {
    const aiString& name = scene.mMeshes[mesh]->mName;
    return "object " + std::to_string(mesh) +
           (name.length > 0 ? " (" + std::string(name.C_Str()) + ")" : "");
}

/// Checks what the importer has made before anything follows its indices.
void checkScene(const aiScene& scene, const fs::path& path, std::vector<std::string>& warnings) {
    std::size_t faces = 0;
    std::size_t flat = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
            const aiVector3D& p = mesh.mVertices[i];
            if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
            fail(path, "has a coordinate that is not finite, at point " + std::to_string(i) +
                           " of " + nameOf(scene, m));
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            ++(face.mNumIndices < 3 ? flat : faces);
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                if (face.mIndices[i] < mesh.mNumVertices) continue;
                fail(path, "has a face that refers to point " + std::to_string(face.mIndices[i]) +
                               " of " + nameOf(scene, m) + "; expected less than " +
                               std::to_string(mesh.mNumVertices));
            }
        }
    }
    if (faces == 0) fail(path, "has no faces; expected a surface");
    if (flat > 0) {
        warnings.push_back(std::to_string(flat) +
                           " points and lines among the faces were left out");
    }
}

/// Complains if the importer has left out some of the triangles that a glTF file says it has.
void checkComplete(const aiScene& scene, std::size_t expected, const fs::path& path) {
    std::size_t found = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        found += static_cast<std::size_t>(
            std::count_if(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                          [](const aiFace& face) { return face.mNumIndices == 3; }));
    }
    if (found >= expected) return;
    fail(path, "has " + std::to_string(expected - found) + " of its " + std::to_string(expected) +
                   " triangles referring to points that it does not have; expected none");
}

/// The importer keeps coordinates in single precision, so far from the origin they are coarse.
/// Complains if that is much of the object's size; `reach` is the largest coordinate, world units.
void checkPrecision(const Mesh& mesh, double reach, const fs::path& path,
                    std::vector<std::string>& warnings) {
    constexpr double kWorthAWord = 1e-5;
    constexpr double kTooCoarse = 1e-3;
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& point : mesh.points) box.expand(point);
    const openvdb::Vec3d extents = box.extents();
    const double size = std::max({extents.x(), extents.y(), extents.z()});
    const double step = reach * std::numeric_limits<float>::epsilon();
    if (!(step > kWorthAWord * size)) return;
    const std::string found = "has coordinates up to " + inShort(reach) +
                              ", which are read in single precision, to " + inShort(step) +
                              " units, and the object is only " + inShort(size) +
                              " long; move it to the origin";
    if (step > kTooCoarse * size) fail(path, found);
    warnings.push_back("it " + found);
}

/// Appends a mesh under a transform. Returns how far its points reach from the origin of its own
/// coordinates, along an axis, in world units.
double appendMesh(const aiMesh& source, const Matrix& transform, const fs::path& path, Mesh& mesh) {
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (mesh.points.size() + source.mNumVertices > kMost) {
        fail(path, "has more than " + std::to_string(kMost) + " points; expected fewer");
    }
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    double largest = 0;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        const aiVector3D& v = source.mVertices[i];
        const aiVector3t<double> p = transform * aiVector3t<double>(v.x, v.y, v.z);
        mesh.points.emplace_back(p.x, p.y, p.z);
        largest = std::max<double>({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        if (!mesh.points.back().isFinite()) {
            fail(path, "has an object under a transform that makes it infinite");
        }
    }

    // A reflection exchanges the sides of a face.
    const double determinant = transform.Determinant();
    const bool reflects = determinant < 0.0;
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices != 3) continue;
        openvdb::Vec3I t(first + face.mIndices[0], first + face.mIndices[1],
                         first + face.mIndices[2]);
        if (reflects) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
    }
    return largest * std::cbrt(std::abs(determinant));
}

/// Appends every mesh of every node, each as often as nodes refer to it.
void appendNodes(const aiScene& scene, const fs::path& path, MeshFile& file) {
    double reach = 0;
    std::vector<std::pair<const aiNode*, Matrix>> pending = {{scene.mRootNode, Matrix()}};
    while (!pending.empty()) {
        const auto [node, parent] = pending.back();
        pending.pop_back();
        const Matrix transform = parent * static_cast<Matrix>(node->mTransformation);
        for (unsigned i = 0; i < node->mNumMeshes; ++i) {
            reach = std::max(
                reach, appendMesh(*scene.mMeshes[node->mMeshes[i]], transform, path, file.mesh));
            ++file.objects;
        }
        for (unsigned i = node->mNumChildren; i-- > 0;) {
            pending.emplace_back(node->mChildren[i], transform);
        }
    }
    checkPrecision(file.mesh, reach, path, file.warnings);
}

}  // namespace

const std::vector<std::string>& meshExtensions() {
    static const std::vector<std::string> extensions = {".obj",  ".ply", ".stl", ".off",
                                                        ".gltf", ".glb", ".fbx", ".dae"};
    return extensions;
}

bool isMeshFile(const fs::path& path) {
    const auto& known = meshExtensions();
    return std::find(known.begin(), known.end(), lowerExtension(path)) != known.end();
}

MeshFile readMesh(const fs::path& path, Progress& progress) {
    checkFile(path);
    const std::string extension = lowerExtension(path);
    const ProgressStage stage(progress, "read mesh", kSteps);
    MeshFile file;
    MeshFileFacts facts = checkMeshFile(path, extension);
    file.warnings = std::move(facts.warnings);
    progress.throwIfInterrupted();

    Assimp::Importer importer;
    importer.SetProgressHandler(new ImportProgress(progress));  // it takes ownership
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);

    // Read without any step that follows indices, check them, then split polygons.
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    progress.throwIfInterrupted();
    if (scene == nullptr) fail(path, std::string("is malformed: ") + importer.GetErrorString());
    checkScene(*scene, path, file.warnings);
    checkComplete(*scene, facts.triangles, path);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    progress.throwIfInterrupted();
    if (scene == nullptr || scene->mRootNode == nullptr) {
        fail(path, std::string("cannot be split into triangles: ") + importer.GetErrorString());
    }

    appendNodes(*scene, path, file);
    if (file.mesh.triangles.empty()) fail(path, "has no faces; expected a surface");
    return file;
}

}  // namespace bandvox

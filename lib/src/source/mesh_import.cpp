#include "source/mesh_import.h"

#include "core/letter_case.h"
#include "core/rehearsal.h"
#include "core/words.h"
#include "source/checked_files.h"
#include "source/file_integrity.h"

#include <bandvox/core/error.h>

#include <assimp/ProgressHandler.hpp>
#include <assimp/postprocess.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

/// Steps that the importer's progress is told in.
constexpr int kSteps = 100;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::Input, "\"" + path.string() + "\" " + what);
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
            // The importer takes it for a polygon, and stops the process when it finds none.
            if (face.mNumIndices == 0) {
                fail(path, "has a face without corners, in " + nameOf(scene, m) +
                               "; expected at least one corner");
            }
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

/// Of files that refer to themselves in ways that no check here follows all of, what reading one
/// may take; nothing of others, whose checks leave the importer no way to go wrong.
std::optional<RehearsalLimits> rehearsalLimits(const fs::path& path) {
    constexpr std::int64_t kSeconds = 8, kBytesPerSecond = 1'000'000;
    constexpr std::int64_t kBytes = 600'000'000, kBytesPerByte = 200;
    const std::string extension = lowerExtension(path);
    const bool hasBuffers = extension == ".gltf" || extension == ".glb";
    if (!hasBuffers && extension != ".fbx" && extension != ".dae") return std::nullopt;
    std::error_code ignored;
    const auto size = static_cast<std::int64_t>(fs::file_size(path, ignored));
    // What a glTF file says little of may be large, and beside it.
    if (hasBuffers) return RehearsalLimits{kSeconds + size / kBytesPerSecond, 0};
    return RehearsalLimits{kSeconds + size / kBytesPerSecond, kBytes + size * kBytesPerByte};
}

/// Appends a mesh under its transform. Returns how far its points reach from the origin of its own
/// coordinates, along an axis, in world units.
double appendMesh(const MeshInstance& instance, const fs::path& path, Mesh& mesh) {
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    const aiMesh& source = *instance.mesh;
    if (mesh.points.size() + source.mNumVertices > kMost) {
        fail(path, "has more than " + std::to_string(kMost) + " points; expected fewer");
    }
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    double largest = 0;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        const aiVector3D& v = source.mVertices[i];
        const aiVector3t<double> p = instance.transform * aiVector3t<double>(v.x, v.y, v.z);
        mesh.points.emplace_back(p.x, p.y, p.z);
        largest = std::max<double>({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        if (!mesh.points.back().isFinite()) {
            fail(path, "has an object under a transform that makes it infinite");
        }
    }
    forEachTriangle(instance, [&](const openvdb::Vec3I& corners) {
        mesh.triangles.push_back(openvdb::Vec3I(first) + corners);
    });
    return largest * std::cbrt(std::abs(instance.transform.Determinant()));
}

}  // namespace

void MeshImport::read(Progress& progress, std::size_t triangles) {
    // It takes ownership of both.
    mImporter.SetProgressHandler(new ImportProgress(progress));
    mImporter.SetIOHandler(new CheckedFiles(mPath, lowerExtension(mPath) == ".obj"));
    mImporter.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                 aiPrimitiveType_POINT | aiPrimitiveType_LINE);

    // Read without any step that follows indices, check them, then split polygons.
    const aiScene* scene = mImporter.ReadFile(mPath.string(), 0);
    progress.throwIfInterrupted();
    if (scene == nullptr) fail(mPath, std::string("is malformed: ") + mImporter.GetErrorString());
    checkScene(*scene, mPath, mWarnings);
    checkComplete(*scene, triangles, mPath);
    scene = mImporter.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    progress.throwIfInterrupted();
    if (scene == nullptr || scene->mRootNode == nullptr) {
        fail(mPath, std::string("cannot be split into triangles: ") + mImporter.GetErrorString());
    }
}

MeshImport::MeshImport(const fs::path& path, Progress& progress) : mPath(path) {
    checkFile(path);
    const ProgressStage stage(progress, "read mesh", kSteps);
    MeshFileFacts facts = checkMeshFile(path, lowerExtension(path));
    mWarnings = std::move(facts.warnings);
    progress.throwIfInterrupted();

    if (const auto limits = rehearsalLimits(path)) {
        const std::string wrong = rehearse(
            [&] {
                Progress silent;
                read(silent, facts.triangles);
                return std::string();
            },
            *limits, progress);
        if (wrong.starts_with('"')) throw Error(ErrorKind::Input, wrong);
        if (!wrong.empty()) fail(path, "is malformed: its importer " + wrong);
    }
    read(progress, facts.triangles);
}

std::vector<MeshInstance> MeshImport::instances() const {
    std::vector<MeshInstance> found;
    std::vector<std::pair<const aiNode*, MeshInstance::Transform>> pending = {
        {scene().mRootNode, MeshInstance::Transform()}};
    while (!pending.empty()) {
        const auto [node, parent] = pending.back();
        pending.pop_back();
        const auto transform = parent * static_cast<MeshInstance::Transform>(node->mTransformation);
        for (unsigned i = 0; i < node->mNumMeshes; ++i) {
            found.push_back({scene().mMeshes[node->mMeshes[i]], transform});
        }
        for (unsigned i = node->mNumChildren; i-- > 0;) {
            pending.emplace_back(node->mChildren[i], transform);
        }
    }
    return found;
}

MeshFile MeshImport::file() const {
    MeshFile file;
    file.warnings = mWarnings;
    double reach = 0;
    for (const MeshInstance& instance : instances()) {
        reach = std::max(reach, appendMesh(instance, mPath, file.mesh));
        ++file.objects;
    }
    checkPrecision(file.mesh, reach, mPath, file.warnings);
    if (file.mesh.triangles.empty()) fail(mPath, "has no faces; expected a surface");
    return file;
}

}  // namespace bandvox

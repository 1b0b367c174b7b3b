#include "core/letter_case.h"
#include "core/words.h"
#include "mesh/mesh_checksum.h"
#include "mesh/mesh_formats.h"
#include "source/mesh_bounds.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/mesh/write_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bandvox {

namespace {

struct MeshFormat {
    const char* extension;
    void (*write)(ByteOutput& output, const WritableMesh& mesh);
    bool holdsColors, holdsNotes;
};

constexpr std::array kMeshFormats{
    MeshFormat{".obj", writeObj, true, true}, MeshFormat{".ply", writePly, true, true},
    MeshFormat{".stl", writeStl, false, false}, MeshFormat{".gltf", writeGltf, true, true},
    MeshFormat{".glb", writeGlb, true, true}};

const MeshFormat* formatOf(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    const auto* found =
        std::find_if(kMeshFormats.begin(), kMeshFormats.end(),
                     [&](const MeshFormat& format) { return extension == format.extension; });
    return found == kMeshFormats.end() ? nullptr : found;
}

void requireOnePerPoint(const char* what, std::size_t found, std::size_t points) {
    if (found == points) return;
    throw Error(ErrorKind::Usage, "a mesh to be written has " + std::to_string(found) + " " + what +
                                      "; expected one for each of its " + std::to_string(points) +
                                      " points");
}

void requireSound(const SurfaceMesh& surface) {
    const std::size_t points = surface.mesh.points.size();
    if (surface.mesh.triangles.empty()) {
        throw Error(ErrorKind::Usage, "a mesh to be written has no triangles");
    }
    requireOnePerPoint("normals", surface.normals.size(), points);
    if (!surface.colors.empty()) requireOnePerPoint("colours", surface.colors.size(), points);
    // Formats store signed numbers of points, or unsigned ones of triangles.
    constexpr std::size_t kMostPoints = std::numeric_limits<std::int32_t>::max();
    constexpr std::size_t kMostTriangles = std::numeric_limits<std::uint32_t>::max();
    if (points > kMostPoints || surface.mesh.triangles.size() > kMostTriangles) {
        throw Error(ErrorKind::Result, "the mesh has " + std::to_string(points) +
                                           " points; mesh files hold up to " +
                                           std::to_string(kMostPoints));
    }
    for (const openvdb::Vec3I& t : surface.mesh.triangles) {
        const std::size_t largest = std::max({t[0], t[1], t[2]});
        if (largest < points) continue;
        throw Error(ErrorKind::Usage, "a mesh to be written has a triangle of point " +
                                          std::to_string(largest) + "; expected less than " +
                                          std::to_string(points));
    }
}

// Part of the mesh's size to which single precision rounds where it is.
double coarseness(const openvdb::BBoxd& box) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        reach = std::max({reach, std::abs(box.min()[axis]), std::abs(box.max()[axis])});
    }
    const openvdb::Vec3d sides = box.extents();
    return reach * std::numeric_limits<float>::epsilon() / std::max({sides[0], sides[1], sides[2]});
}

}  // namespace

const std::vector<std::string>& writableMeshExtensions() {
    static const std::vector<std::string> extensions = [] {
        std::vector<std::string> all(kMeshFormats.size());
        std::transform(kMeshFormats.begin(), kMeshFormats.end(), all.begin(),
                       [](const MeshFormat& format) { return format.extension; });
        return all;
    }();
    return extensions;
}

bool isWritableMesh(const std::filesystem::path& path) {
    return formatOf(path) != nullptr;
}

bool holdsColors(const std::filesystem::path& path) {
    const MeshFormat* format = formatOf(path);
    return format != nullptr && format->holdsColors;
}

bool holdsNotes(const std::filesystem::path& path) {
    const MeshFormat* format = formatOf(path);
    return format != nullptr && format->holdsNotes;
}

void writeMesh(AtomicFile& file, const SurfaceMesh& surface, Progress& progress) {
    const MeshFormat* format = formatOf(file.target());
    if (format == nullptr) {
        std::string known;
        for (const std::string& extension : writableMeshExtensions())
            known.append(" ").append(extension);
        throw Error(ErrorKind::Usage, "cannot write " + file.target().string() +
                                          ": expected a name that ends in one of" + known);
    }
    requireSound(surface);
    // At this part of its size the neighbours of a fine mesh begin to fall together.
    constexpr double kWorthDouble = 1e-6;
    constexpr double kTooCoarse = 1e-4;
    WritableMesh mesh{surface, boundsOf(surface.mesh), false, surface.notes};
    // What goes straight to its target cannot be gone back in.
    const bool isChecked = !mesh.notes.empty() && format->holdsNotes && !file.inPlace();
    if (isChecked) mesh.notes.push_back(kChecksumMark + kUnknownChecksum);
    const double coarse = coarseness(mesh.box);
    mesh.needsDouble = coarse > kWorthDouble;
    if (coarse > kTooCoarse && format->write == writeStl) {
        throw Error(ErrorKind::Result,
                    "an .stl holds coordinates in single precision, which is " + inShort(coarse) +
                        " of this mesh's size, so far from the origin it is; expected another "
                        "kind of file");
    }
    ByteOutput output(file, progress);
    format->write(output, mesh);
    output.close();
    if (isChecked) storeChecksum(file.temporary(), output.checksum());
}

void writeMesh(const std::filesystem::path& path, const SurfaceMesh& surface) {
    AtomicFile file(path);
    writeMesh(file, surface);
    file.commit();
}

}  // namespace bandvox

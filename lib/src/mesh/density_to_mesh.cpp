#include "core/words.h"
#include "mesh/collapse_points.h"
#include "mesh/mesh_assembly.h"
#include "render/object_colors.h"
#include "render/picture_request.h"
#include "render/surface_field.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/density_to_mesh.h>

#include <algorithm>
#include <memory>

namespace bandvox {

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace {

constexpr std::size_t kPointsPerTask = 4096;

// Of the distance that is allowed, the part that reading between nodes may take, as density: no
// surface is much flatter than that of a solid, which rises by 0.28 per voxel.
constexpr double kReadingPart = 0.05;

// Only the bricks that threads are at, and their neighbours, are needed.
constexpr std::size_t kMeshCacheBytes = std::size_t(256) << 20;

// What an adaptivity of 1 allows, voxels.
constexpr double kFarthestMove = 0.25;
constexpr double kRegionVoxels = 64;

void requireRange(const char* what, double found, double low, double high) {
    if (found >= low && found <= high) return;
    throw Error(ErrorKind::Usage, std::string("the mesh's ") + what + " is " + inShort(found) +
                                      "; it must be " + inShort(low) + " to " + inShort(high));
}

[[noreturn]] void failWithoutSurface(const DrawableGrid& drawable) {
    const openvdb::FloatGrid& grid = *drawable.grid;
    float maximum = grid.background();
    for (auto value = grid.cbeginValueOn(); value; ++value) maximum = std::max(maximum, *value);
    throw Error(ErrorKind::Result,
                drawable.isLevelSet
                    ? "the mesh would be empty: the level set is at least " + inShort(-maximum) +
                          ", above the iso-value " + inShort(-drawable.iso)
                    : "the mesh would be empty: the density is at most " + inShort(maximum) +
                          ", below the iso-value " + inShort(drawable.iso));
}

// Where the field has no gradient, the triangles around a point say where outward is.
void completeNormals(SurfaceMesh& surface) {
    std::vector<Vec3f>& normals = surface.normals;
    const auto isMissing = [](const Vec3f& normal) { return normal.lengthSqr() == 0; };
    if (std::none_of(normals.begin(), normals.end(), isMissing)) return;
    std::vector<Vec3d> sums(normals.size(), Vec3d(0.0));
    const std::vector<Vec3d>& points = surface.mesh.points;
    for (const openvdb::Vec3I& t : surface.mesh.triangles) {
        const Vec3d area = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
        for (int k = 0; k < 3; ++k) sums[t[k]] += area;
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (!isMissing(normals[i])) continue;
        const double length = sums[i].length();
        normals[i] = length > 0 ? Vec3f(sums[i] / length) : Vec3f(0, 0, 1);
    }
}

double volumeInside(const Mesh& mesh) {
    // About a point of the mesh, wherever that is, little cancels.
    const Vec3d origin = mesh.points.front();
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        sum += (mesh.points[t[0]] - origin)
                   .dot((mesh.points[t[1]] - origin).cross(mesh.points[t[2]] - origin));
    }
    return sum / 6;
}

// Each point has the colour of the grid there. Returns how many have none.
std::size_t paint(SurfaceMesh& surface, const openvdb::Vec3SGrid::ConstPtr& grid,
                  Progress& progress) {
    const ObjectColors colors(grid);
    const Vec3f background = grid->background();
    const std::size_t count = surface.mesh.points.size();
    surface.colors.resize(count);
    const std::size_t tasks = (count + kPointsPerTask - 1) / kPointsPerTask;
    std::vector<std::size_t> missing(tasks, 0);
    const ProgressStage stage(progress, "colour points", static_cast<std::int64_t>(tasks));
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kPointsPerTask;
        for (std::size_t i = begin; i < std::min(begin + kPointsPerTask, count); ++i) {
            const auto color = colors.at(surface.mesh.points[i]);
            surface.colors[i] = color ? Vec3f(*color) : background;
            if (!color) ++missing[task];
        }
        progress.advance();
    });
    std::size_t sum = 0;
    for (const std::size_t part : missing) sum += part;
    return sum;
}

}  // namespace

MeshResult densityToMesh(const openvdb::FloatGrid::ConstPtr& grid, const MeshOptions& options,
                         Progress& progress) {
    if (!grid) throw Error(ErrorKind::Usage, "a mesh needs a grid, but got none");
    requireRange("adaptivity", options.adaptivity, 0, 1);
    requireRange("tolerance, voxels,", options.tolerance, 1e-5, 0.1);
    const DrawableGrid drawable = makeDrawable(grid, options.iso);
    PictureOptions reading;
    reading.tolerance = std::max(kReadingPart * options.tolerance, 1e-6);
    reading.cacheBytes = kMeshCacheBytes;
    const auto reconstruction = readLattice(drawable.grid, drawable.metadata, reading);

    MeshAssembly assembly({*drawable.grid, *reconstruction, drawable.iso, options.tolerance},
                          progress);
    if (assembly.empty()) failWithoutSurface(drawable);
    MeshResult result;
    result.surface = assembly.make();
    result.iso = drawable.isLevelSet ? -drawable.iso : drawable.iso;
    result.cells = assembly.cells();
    result.ambiguousFaces = assembly.ambiguousFaces();
    completeNormals(result.surface);
    if (options.adaptivity > 0) {
        const double voxel = shortestVoxelSide(*grid);
        result.pointsCollapsed = collapsePoints(
            result.surface, {kFarthestMove * options.adaptivity * voxel, kRegionVoxels * voxel},
            progress);
    }
    result.volume = volumeInside(result.surface.mesh);
    if (options.colors) {
        const std::size_t missing = paint(result.surface, options.colors, progress);
        if (missing > 0) {
            result.warnings.push_back(counted(missing, "point", "points") +
                                      " of the mesh lie where the grid of colours has none, and "
                                      "have its background");
        }
    }
    return result;
}

}  // namespace bandvox

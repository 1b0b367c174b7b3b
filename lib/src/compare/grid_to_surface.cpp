#include "compare/refined_surface.h"
#include "render/picture_request.h"
#include "render/surface_field.h"

#include <bandvox/compare/grid_to_surface.h>
#include <bandvox/core/error.h>
#include <bandvox/mesh/density_to_mesh.h>

#include <utility>

namespace bandvox {

namespace {

// As density; distances are a few times that, in voxels.
constexpr double kReadingTolerance = 1e-5;
constexpr std::size_t kSurfaceCacheBytes = std::size_t(256) << 20;
constexpr int kMostCuts = 3;

}  // namespace

SurfaceOfGrid gridToSurface(const openvdb::FloatGrid::ConstPtr& grid,
                            const GridToSurfaceOptions& options, Progress& progress) {
    if (!grid) throw Error(ErrorKind::Usage, "a surface needs a grid, but got none");
    if (options.cuts < 0 || options.cuts > kMostCuts) {
        throw Error(ErrorKind::Usage, "triangles should be cut " + std::to_string(options.cuts) +
                                          " times; it must be 0 to " + std::to_string(kMostCuts));
    }
    MeshOptions meshing;
    meshing.iso = options.iso;
    meshing.tolerance = 1e-4;
    MeshResult made = densityToMesh(grid, meshing, progress);

    SurfaceOfGrid result;
    result.iso = made.iso;
    result.volume = made.volume;
    result.voxel = shortestVoxelSide(*grid);
    const DrawableGrid drawable = makeDrawable(grid, options.iso);
    PictureOptions reading;
    reading.tolerance = kReadingTolerance;
    reading.cacheBytes = kSurfaceCacheBytes;
    const auto field = readLattice(drawable.grid, drawable.metadata, reading);
    const IsoSurface surface{*field, drawable.grid->transform(), drawable.iso};
    SurfaceMesh mesh = std::move(made.surface);
    for (int cut = 0; cut < options.cuts; ++cut) mesh = cutTriangles(mesh, surface, progress);
    result.surface.deviation = measureDeviation(mesh.mesh, surface, progress);
    result.surface.mesh = std::move(mesh.mesh);
    result.surface.normals = std::move(mesh.normals);
    return result;
}

}  // namespace bandvox

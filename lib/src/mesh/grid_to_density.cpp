#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/grid_surface.h>
#include <bandvox/mesh/grid_to_density.h>
#include <bandvox/resample/cubic_lattice.h>

namespace bandvox {

DensityResult gridToDensity(const openvdb::FloatGrid::ConstPtr& grid,
                            const openvdb::math::Transform& target,
                            const GridDensityOptions& options, Progress& progress) {
    if (!hasCubicVoxels(target)) {
        throw Error(ErrorKind::Usage,
                    "the lattice for a solid has voxels that are no cubes; "
                    "expected cubes");
    }
    // The lattice upright, and its voxel 0 at the origin: then index i lies at i·Δ.
    const double side = target.voxelSize()[0];
    openvdb::Mat4d toLattice = target.baseMap()->getAffineMap()->getMat4().inverse();
    toLattice.postScale(openvdb::Vec3d(side));
    DensityOptions density = options.density;
    density.voxelSize = side;
    const auto source = makeGridSurface(options.source, grid, {options.iso, toLattice}, progress);
    DensityResult result = surfaceToDensity(*source, density, progress);
    result.grid->setTransform(target.copy());
    // On a turned lattice its last digits are others, and parts are summed up there.
    result.metadata.gridVolume = densityIntegral(*result.grid);
    setDensityMetadata(*result.grid, result.metadata);
    setPlaceMetadata(*result.grid, placeMetadata(*grid));
    return result;
}

}  // namespace bandvox

#include "bandlimit/density_steps.h"
#include "bandlimit/grid_difference.h"
#include "core/words.h"
#include "source/mesh_bounds.h"

#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/source/joined_source.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/soup_source.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

namespace {

std::string largeError(double error, double tolerance, int rows) {
    return "the sampling error is up to " + inShort(error) + ", above the tolerance of " +
           inShort(tolerance) + "; more than " + std::to_string(rows) + " rows to a voxel lower it";
}

}  // namespace

DensityResult soupToDensity(const SoupOfTriangles& triangles, const SoupDensityOptions& options,
                            Progress& progress) {
    // Choose the lattice, for both parts together.
    requireValid(options.density);
    if (!(options.samplingTolerance >= 0)) {
        throw Error(ErrorKind::Usage, "the tolerance of the sampling is " +
                                          inShort(options.samplingTolerance) +
                                          "; it must not be negative");
    }
    openvdb::BBoxd bounds = boundsOf(triangles.soup);
    if (!triangles.solid.points.empty()) bounds.expand(boundsOf(triangles.solid));
    DensityOptions density = options.density;
    density.voxelSize = chooseVoxelSize(triangles.name, bounds, options.density);

    // Follow the soup's rows, and filter what they and the solid's surface give.
    const Mesh* beside = density.sumOverlaps ? nullptr : &triangles.solid;
    const SoupSource soup(triangles.name, triangles.soup,
                          {density.voxelSize, options.rowsPerVoxel, beside}, progress);
    std::optional<MeshSource> solid;
    if (!triangles.solid.triangles.empty()) solid.emplace(triangles.name, triangles.solid);
    const auto convert = [&](const SoupSource& rows) {
        std::vector<const BoundarySource*> parts{&rows};
        if (solid) parts.push_back(&*solid);
        return surfaceToDensity(JoinedSource(triangles.name, parts), density, progress);
    };
    DensityResult result = convert(soup);
    result.metadata.route = "winding";
    result.metadata.oversampling = options.rowsPerVoxel;

    // Measure what the rows cannot tell.
    const DensityResult coarse = convert(*soup.withFewerRows());
    // A lattice twice as wide is wrong by at least twice as much, so by at least as much more.
    const double error = largestDifference(*result.grid, *coarse.grid);
    result.metadata.samplingError = error;
    if (error > options.samplingTolerance) {
        result.warnings.push_back(
            largeError(error, options.samplingTolerance, options.rowsPerVoxel));
    }
    return result;
}

}  // namespace bandvox

// bandvox convert for points: with radii the union of balls, with normals the solid whose surface
// they lie on.

#include "convert_points.h"

#include "density_report.h"
#include "solid_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/grid/balls_to_solid_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/oriented_points_to_solid_grid.h>
#include <bandvox/mesh/grid_surface.h>
#include <bandvox/source/point_cloud.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

namespace bandvox::app {
namespace {

/// What points are taken for, in the order in which --points names it.
enum class PointKind { Auto, Balls, Surface };

struct PointRequest {
    std::string input;
    PointKind kind = PointKind::Auto;
    std::optional<double> radius;  ///< of all points
    DensityOptions density;
    SolidOutput output;
};

PointRequest parsePoints(const CommandLine& line) {
    PointRequest request;
    request.input = line.positional(0);
    request.output = readSolidOutput(line, "points");
    refuseOptions(line,
                  {"grid", "background", "factor", "onto", "no-filter", "threshold", "route",
                   "oversample", "overlap", "color"},
                  "for points");
    readStackRequest(line, request.input);  // refuses
    request.kind = static_cast<PointKind>(line.choice("points", 0));
    if (line.has("radius")) request.radius = line.number("radius", {.low = 0, .lowOpen = true}, 1);
    if (request.radius && request.kind == PointKind::Surface) {
        throw Error(ErrorKind::Usage,
                    "--radius has no meaning with --points surface; expected one of them");
    }
    DensityOptions& density = request.density;
    readSize(line, density.resolution, density.voxelSize);
    density.tolerance = line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    readDensityOptions(line, request.output, density);
    return request;
}

// What is asked for, or what the file has.
PointKind chooseKind(CommandRun& run, const PointRequest& request, const PointCloud& cloud) {
    const bool hasRadii = !cloud.radii.empty();
    const bool hasNormals = !cloud.normals.empty();
    if (request.radius) {
        if (hasRadii) run.say("         its own radii are not used, since --radius was given");
        return PointKind::Balls;
    }
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::Input, "'" + request.input + "' has points without " + what);
    };
    if (request.kind == PointKind::Balls && !hasRadii) {
        fail("radii; expected a radius for each, or --radius R for all");
    }
    if (request.kind == PointKind::Surface && !hasNormals) {
        fail("normals; expected a normal for each, outward");
    }
    if (request.kind != PointKind::Auto) return request.kind;
    if (!hasRadii && !hasNormals) {
        fail(
            "radii and normals, of which no solid can be made; expected --radius R, one radius "
            "for all of them, or a radius or a normal for each");
    }
    if (hasRadii && hasNormals) {
        run.say(
            "         it has radii and normals; balls are made of it, and --points surface "
            "would take its normals");
    }
    return hasRadii ? PointKind::Balls : PointKind::Surface;
}

// The side of the density's voxels.
double voxelSizeFor(const PointRequest& request, const openvdb::BBoxd& box) {
    if (request.density.voxelSize > 0) return request.density.voxelSize;
    const openvdb::Vec3d size = box.extents();
    const double longest = std::max({size[0], size[1], size[2]});
    if (!(longest > 0)) {
        throw Error(ErrorKind::Input, "the points of '" + request.input +
                                          "' are all in one place, which is no solid; expected "
                                          "others, or radii above 0");
    }
    return longest / request.density.resolution;
}

openvdb::FloatGrid::Ptr gridOfBalls(CommandRun& run, PointRequest& request, PointCloud& cloud) {
    if (request.radius) cloud.radii.assign(cloud.points.size(), *request.radius);
    const Balls balls{cloud.points, cloud.radii};
    request.density.voxelSize = voxelSizeFor(request, balls.bounds());
    BallGrid drawn = ballsToSolidGrid(balls, request.density.voxelSize, run.progress());
    const double voxel = drawn.grid->voxelSize()[0];
    const auto [smallest, largest] = std::minmax_element(cloud.radii.begin(), cloud.radii.end());
    run.say("balls    of radius " + formatNumber(*smallest) + " to " + formatNumber(*largest) +
            ", drawn on voxels of side " + formatNumber(voxel));
    run.count("balls_too_small", drawn.tooSmall);
    run.count("lattice_voxel_size", voxel);
    if (drawn.tooSmall > 0) {
        std::string warning =
            formatCount(static_cast<std::int64_t>(drawn.tooSmall), "ball", "balls");
        warning += " of " + std::to_string(cloud.points.size());
        warning += " are too small for these voxels and were left out, of a volume of ";
        warning += formatNumber(drawn.lostVolume, 3);
        warning += " in all; use more voxels, or a larger radius";
        run.warn({warning}, ErrorKind::Result);
    }
    return drawn.grid;
}

openvdb::FloatGrid::Ptr gridOfSurface(CommandRun& run, PointRequest& request,
                                      const PointCloud& cloud) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& point : cloud.points) box.expand(point);
    request.density.voxelSize = voxelSizeFor(request, box);
    OrientedPointsGrid fitted = orientedPointsToSolidGrid(
        {cloud.points, cloud.normals}, request.density.voxelSize, run.progress());
    const double voxel = fitted.grid->voxelSize()[0];
    run.say("surface  through points " + formatNumber(fitted.spacing, 3) +
            " apart, read on voxels of side " + formatNumber(voxel));
    run.count("point_spacing", fitted.spacing);
    run.count("unsupported_surface", fitted.unsupported);
    run.count("normals_turned", fitted.turned);
    run.count("lattice_voxel_size", voxel);
    run.warn(fitted.warnings, ErrorKind::Input);
    return fitted.grid;
}

DensityResult densityOfPoints(CommandRun& run, PointRequest& request) {
    PointCloud cloud = readPointCloud(request.input, run.progress());
    std::string found =
        formatCount(static_cast<std::int64_t>(cloud.points.size()), "point", "points");
    if (!cloud.radii.empty()) found += ", with radii";
    if (!cloud.normals.empty()) found += ", with normals";
    run.say("read     " + request.input + ": " + found);
    run.count("points", cloud.points.size());
    const openvdb::FloatGrid::Ptr grid = chooseKind(run, request, cloud) == PointKind::Balls
                                             ? gridOfBalls(run, request, cloud)
                                             : gridOfSurface(run, request, cloud);
    const std::string name = std::filesystem::path(request.input).filename().string();
    const auto source = makeGridSurface(name, grid, {}, run.progress());
    return surfaceToDensity(*source, request.density, run.progress());
}

}  // namespace

std::vector<OptionEntry> pointEntries() {
    const std::string group = "Points as input";
    return {
        {"points",
         0,
         "KIND",
         "auto",
         "balls: the union of balls around the points. surface: the solid whose surface the points "
         "lie on, by their normals. auto: balls if there are radii, else the surface.",
         group,
         {.words = {"auto", "balls", "surface"}}},
        {"radius", 0, "R", "", "One radius for all points, in units of the file.", group},
    };
}

bool takesPoints(const CommandLine& line) {
    const std::string& input = line.positional(0);
    return !isShape(input) && isPointCloudFile(input);
}

void convertPoints(ConvertJob& job) {
    PointRequest request = parsePoints(job.line());
    if (!job.begin()) return;
    CommandRun& run = job.run();
    std::optional<AtomicFile> file = request.output.openFile();
    DensityResult density = densityOfPoints(run, request);
    finishDensity(run, request.output, density.grid, density.metadata);
    sayDensity(run, density, exactErrorInWords(request.output, density.metadata));
    run.warn(density.warnings, ErrorKind::Result);
    writeSolid(job, file, request.output, request.density, density.grid);
}

}  // namespace bandvox::app

// Points to band-limited densities: of balls around them, or of the solid whose surface they are
// on.

#include "arrays.h"
#include "bindings.h"
#include "choices.h"
#include "density_request.h"
#include "paths.h"
#include "scattered_arrays.h"
#include "solid_mesh.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/balls_to_solid_grid.h>
#include <bandvox/grid/oriented_points_to_solid_grid.h>
#include <bandvox/mesh/grid_surface.h>
#include <bandvox/source/point_cloud.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// What points are taken for, in the order in which `points` names it.
enum class PointKind { Auto, Balls, Surface };

struct PointRequest : DensityRequest {
    std::filesystem::path path;  // empty for arrays
    PointCloud cloud;            // of arrays
    std::optional<double> radius;
    PointKind kind = PointKind::Auto;

    std::string name() const { return path.empty() ? "points" : path.filename().string(); }
};

std::vector<openvdb::Vec3d> finiteVectorsOf(const py::object& object, const char* what) {
    std::vector<openvdb::Vec3d> vectors = vectorsOf(object, what);
    for (const openvdb::Vec3d& vector : vectors) {
        if (vector.isFinite()) continue;
        throw Error(ErrorKind::Usage,
                    std::string(what) + ": found a number that is not finite; expected none");
    }
    return vectors;
}

/// One radius for all, or one for each.
void takeRadii(const py::object& radius, PointRequest& request) {
    if (radius.is_none()) return;
    const std::size_t count = request.cloud.points.size();
    const std::string expected = "a number above 0, or one for each point, 0 or more";
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(
        numericArray(radius, "radius", expected));
    const bool isOne = numbers.ndim() == 0;
    const bool fits = isOne || (numbers.ndim() == 1 && request.path.empty() &&
                                static_cast<std::size_t>(numbers.size()) == count);
    const bool isLength = std::all_of(numbers.data(), numbers.data() + numbers.size(),
                                      [](double one) { return one >= 0 && one <= 1e30; });
    if (!fits || !isLength || (isOne && !(*numbers.data() > 0))) {
        throw Error(ErrorKind::Usage,
                    "radius: found " + described(numbers) + "; expected " + expected);
    }
    if (isOne) {
        request.radius = *numbers.data();
    } else {
        request.cloud.radii.assign(numbers.data(), numbers.data() + count);
    }
}

void takeNormals(const py::object& normals, PointRequest& request) {
    if (normals.is_none()) return;
    if (!request.path.empty()) {
        throw Error(ErrorKind::Usage, "normals are for arrays of points; a file has its own");
    }
    for (const openvdb::Vec3d& normal : finiteVectorsOf(normals, "normals")) {
        request.cloud.normals.emplace_back(normal);
    }
    if (request.cloud.normals.size() == request.cloud.points.size()) return;
    throw Error(ErrorKind::Usage, "normals: found " + std::to_string(request.cloud.normals.size()) +
                                      "; expected one for each of " +
                                      std::to_string(request.cloud.points.size()) + " points");
}

PointKind chosenKind(const PointRequest& request, const PointCloud& cloud) {
    if (request.radius) return PointKind::Balls;
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::Input, "'" + request.name() + "' has points without " + what);
    };
    if (request.kind == PointKind::Balls && cloud.radii.empty()) {
        fail("radii; expected a radius for each, or one for all");
    }
    if (request.kind == PointKind::Surface && cloud.normals.empty()) {
        fail("normals; expected a normal for each, outward");
    }
    if (request.kind != PointKind::Auto) return request.kind;
    if (cloud.radii.empty() && cloud.normals.empty()) {
        fail(
            "radii and normals, of which no solid can be made; expected radius, or a normal for "
            "each");
    }
    return cloud.radii.empty() ? PointKind::Surface : PointKind::Balls;
}

double voxelSizeOf(const PointRequest& request, const openvdb::BBoxd& box) {
    if (request.options.voxelSize > 0) return request.options.voxelSize;
    if (request.options.resolution < 1) {
        throw Error(
            ErrorKind::Usage,
            "resolution is " + std::to_string(request.options.resolution) + "; expected 1 or more");
    }
    const openvdb::Vec3d size = box.extents();
    const double longest = std::max({size[0], size[1], size[2]});
    if (longest > 0) return longest / request.options.resolution;
    throw Error(ErrorKind::Input, "the points of '" + request.name() +
                                      "' are all in one place, which is no solid; expected "
                                      "others, or radii above 0");
}

openvdb::FloatGrid::Ptr solidOfBalls(PointCloud& cloud, const PointRequest& request,
                                     double& voxelSize, std::vector<std::string>& warnings,
                                     Progress& progress) {
    if (request.radius) cloud.radii.assign(cloud.points.size(), *request.radius);
    const Balls balls{cloud.points, cloud.radii};
    voxelSize = voxelSizeOf(request, balls.bounds());
    const BallGrid drawn = ballsToSolidGrid(balls, voxelSize, progress);
    if (drawn.tooSmall > 0) {
        warnings.push_back(
            std::to_string(drawn.tooSmall) + " of " + std::to_string(cloud.points.size()) +
            " balls are too small for these voxels and were left out, of a volume "
            "of " +
            inDigits(drawn.lostVolume) + " in all; use more voxels, or a larger radius");
    }
    return drawn.grid;
}

openvdb::FloatGrid::Ptr solidOfSurface(const PointCloud& cloud, const PointRequest& request,
                                       double& voxelSize, std::vector<std::string>& warnings,
                                       Progress& progress) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& point : cloud.points) box.expand(point);
    voxelSize = voxelSizeOf(request, box);
    OrientedPointsGrid fitted =
        orientedPointsToSolidGrid({cloud.points, cloud.normals}, voxelSize, progress);
    warnings = std::move(fitted.warnings);
    return fitted.grid;
}

DensityResult densityOfPoints(const PointRequest& request, Progress& progress) {
    PointCloud cloud =
        request.path.empty() ? request.cloud : readPointCloud(request.path, progress);
    DensityOptions options = request.options;
    std::vector<std::string> warnings;
    const auto solid = chosenKind(request, cloud) == PointKind::Balls
                           ? solidOfBalls(cloud, request, options.voxelSize, warnings, progress)
                           : solidOfSurface(cloud, request, options.voxelSize, warnings, progress);
    const auto source = makeGridSurface(request.name(), solid, {}, progress);
    DensityResult result = surfaceToDensity(*source, options, progress);
    result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
    return result;
}

}  // namespace

void bindPoints(py::module_& module) {
    const DensityOptions standard;
    module.def(
        "bandlimit_points",
        [](const py::object& source, const py::object& radius, const py::object& normals,
           const std::string& points, int resolution, double voxelSize, double cutoff, double order,
           const std::optional<double>& tolerance, int tile, bool clamp, const py::object& iso,
           const py::object& shard, int threads, const py::object& progress) {
            PointRequest request{
                densityRequestOf({cutoff, order, tile, clamp}, tolerance, iso, threads, progress)};
            request.options.resolution = resolution;
            request.options.voxelSize = voxelSize;
            request.options.shard = shardOf(shard);
            request.kind =
                static_cast<PointKind>(choiceOf(points, {"auto", "balls", "surface"}, "points"));
            if (isPath(source)) {
                request.path = pathOf(source);
            } else {
                request.cloud.points = finiteVectorsOf(source, "points");
            }
            takeRadii(radius, request);
            takeNormals(normals, request);
            if (request.radius && request.kind == PointKind::Surface) {
                throw Error(ErrorKind::Usage,
                            "radius has no meaning with points='surface'; expected one of them");
            }
            return madeDensity(
                request, [&](Progress& watched) { return densityOfPoints(request, watched); });
        },
        py::arg("source"), py::kw_only(), py::arg("radius") = py::none(),
        py::arg("normals") = py::none(), py::arg("points") = "auto",
        py::arg("resolution") = standard.resolution, py::arg("voxel_size") = 0.0,
        py::arg("cutoff") = standard.filter.cutoff, py::arg("order") = standard.filter.order,
        py::arg("tolerance") = py::none(), py::arg("tile") = 0, py::arg("clamp") = false,
        py::arg("iso") = standard.iso, py::arg("shard") = py::none(), py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(Turns points into the band-limited density of a solid, a Grid.

source: a .ply, .xyz, .csv or .txt file, or an array of points (n, 3), world units. radius: of
balls around them, one for all or (n,), world units; normals: (n, 3), outward, of any length.
points: 'balls', their union; 'surface', the solid whose surface the points lie on, by their
normals; 'auto' takes balls if there are radii. The others are those of bandlimit; with balls too
small for the voxels it warns. Raises InputError for points of which no solid can be made.)");
}

}  // namespace bandvox::python

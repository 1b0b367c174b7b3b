// What is done with grids: read between voxels, resampled, merged, compared, made surfaces of.

#include "arrays.h"
#include "background.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "mesh_object.h"

#include <bandvox/compare/compare_grids.h>
#include <bandvox/compare/compare_surfaces.h>
#include <bandvox/compare/grid_to_surface.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/merge_grids.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/iso_of_volume.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/resample/resample_grid.h>

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <span>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using openvdb::Vec3d;

/// A grid, read between its voxels.
class ReconstructionObject {
  public:
    ReconstructionObject(const openvdb::FloatGrid::Ptr& grid, double tolerance,
                         std::size_t cacheBytes)
        : mGrid(grid) {
        if (const auto metadata = densityMetadata(*grid)) {
            mReconstruction = makeBrickReconstruction(
                grid, {{metadata->order, metadata->cutoff}, tolerance, cacheBytes});
        } else {
            mReconstruction = makeSplineReconstruction(grid, cacheBytes);
        }
        if (!grid->transform().isLinear()) {
            throw Error(ErrorKind::Input, "the grid's transform is not linear");
        }
        mToIndex = grid->transform().baseMap()->getAffineMap()->getMat4().inverse();
    }

    py::array value(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> values(places.size());
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            values[i] = probe.value(place);
        });
        return ownedArray(std::move(values), {static_cast<py::ssize_t>(places.size())});
    }

    py::array gradient(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> gradients(3 * places.size());
        const openvdb::Mat3d turn = mToIndex.getMat3();
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            const Vec3d world = turn * probe.evaluate(place).gradient;
            for (std::size_t k = 0; k < 3; ++k) gradients[3 * i + k] = world[static_cast<int>(k)];
        });
        return ownedArray(std::move(gradients), {static_cast<py::ssize_t>(places.size()), 3});
    }

    py::array hessian(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> entries(9 * places.size());
        const openvdb::Mat3d turn = mToIndex.getMat3();
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            const openvdb::Mat3d world = turn * probe.expand(place).hessian * turn.transpose();
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    entries[9 * i + static_cast<std::size_t>(3 * r + c)] = world(r, c);
                }
            }
        });
        return ownedArray(std::move(entries), {static_cast<py::ssize_t>(places.size()), 3, 3});
    }

  private:
    template <typename Visit>
    void forPlaces(const std::vector<Vec3d>& places, const Visit& visit) const {
        constexpr std::size_t kTogether = 4096;
        const py::gil_scoped_release unlocked;
        const std::size_t pieces = (places.size() + kTogether - 1) / kTogether;
        parallelFor(static_cast<std::int64_t>(pieces), [&](std::int64_t piece) {
            const auto probe = mReconstruction->probe();
            const std::size_t first = static_cast<std::size_t>(piece) * kTogether;
            const std::size_t last = std::min(places.size(), first + kTogether);
            for (std::size_t i = first; i < last; ++i) {
                visit(*probe, mToIndex.transform(places[i]), i);
            }
        });
    }

    openvdb::FloatGrid::Ptr mGrid;
    std::unique_ptr<Reconstruction> mReconstruction;
    openvdb::Mat4d mToIndex;
};

py::object resample(const py::object& object, double factor, double voxelSize,
                    const py::object& onto, bool filter, double cutoff, double order,
                    double tolerance, int threads, const py::object& progress) {
    const auto grid = floatGridOf(object);
    const int asked = (factor != 0) + (voxelSize != 0) + !onto.is_none();
    if (asked != 1) {
        throw Error(ErrorKind::Usage, "expected one of factor, voxel_size and onto, but got " +
                                          std::to_string(asked));
    }
    openvdb::math::Transform::Ptr target;
    if (!onto.is_none()) {
        target = gridOf(onto)->transform().copy();
    } else if (voxelSize != 0) {
        target = uniformLattice(*grid, voxelSize);
    } else {
        if (!(factor > 0)) throw Error(ErrorKind::Usage, "factor: expected a number above 0");
        target = grid->transform().copy();
        target->preScale(factor);
    }
    ResampleOptions options;
    options.filter.reset();
    if (filter) options.filter = ExponentialFilter{order, cutoff};
    options.tolerance = tolerance;
    ResampleResult result = inBackground(progress, threads, [&](Progress& watched) {
        return resampleGrid(grid, *target, options, watched);
    });
    return objectOf(result.grid);
}

py::list detailLevels(const py::object& object, int levels, int threads,
                      const py::object& progress) {
    const auto grid = floatGridOf(object);
    const auto made = inBackground(progress, threads, [&](Progress& watched) {
        return makeDetailLevels(grid, levels, {}, watched);
    });
    py::list result;
    for (const auto& level : made) result.append(objectOf(level));
    return result;
}

py::object merge(const py::iterable& objects, const std::string& operation,
                 std::vector<double> weights, bool clamp, int threads, const py::object& progress) {
    std::vector<openvdb::FloatGrid::ConstPtr> grids;
    for (const py::handle object : objects) grids.push_back(floatGridOf(object));
    MergeOptions options;
    options.operation = static_cast<MergeOperation>(choiceOf(
        operation, {"union", "sum", "max", "blend", "difference", "intersection"}, "operation"));
    options.weights = std::move(weights);
    options.clamp = clamp;
    MergeResult result = inBackground(
        progress, threads, [&](Progress& watched) { return mergeGrids(grids, options, watched); });
    warn(result.warnings);
    return objectOf(result.grid);
}

py::dict compare(const py::object& a, const py::object& b, bool surfaces,
                 const std::optional<double>& iso, int threads, const py::object& progress) {
    const openvdb::FloatGrid::ConstPtr grids[] = {floatGridOf(a), floatGridOf(b)};
    struct Found {
        GridDifference values;
        std::optional<SurfaceDifference> surfaces;
        double volumes[2] = {0, 0};
    };
    const Found found = inBackground(progress, threads, [&](Progress& watched) {
        Found all;
        all.values = compareGrids(grids[0], grids[1], {}, watched);
        if (!surfaces) return all;
        const SurfaceOfGrid first = gridToSurface(grids[0], {.iso = iso}, watched);
        const SurfaceOfGrid second = gridToSurface(grids[1], {.iso = iso}, watched);
        all.volumes[0] = first.volume;
        all.volumes[1] = second.volume;
        all.surfaces = compareSurfaces(first.surface, second.surface,
                                       {.tolerance = 0.1 * first.voxel}, watched);
        return all;
    });
    py::dict result;
    result["maximum"] = found.values.maximum;
    result["rms"] = found.values.rms;
    result["mean"] = found.values.mean;
    result["voxels"] = found.values.voxels;
    result["integrals"] = py::make_tuple(found.values.integralA, found.values.integralB);
    if (found.surfaces) {
        result["volumes"] = py::make_tuple(found.volumes[0], found.volumes[1]);
        result["hausdorff"] = found.surfaces->hausdorff;
        result["mean_distance"] = found.surfaces->meanDistance;
        result["angle_mean"] = found.surfaces->angles.mean;
        result["angle_95"] = found.surfaces->angles.percent95;
    }
    return result;
}

py::object toMesh(const py::object& object, const std::optional<double>& iso, double adaptivity,
                  double tolerance, const py::object& colors, int threads,
                  const py::object& progress) {
    const auto grid = floatGridOf(object);
    MeshOptions options;
    options.iso = iso;
    options.adaptivity = adaptivity;
    options.tolerance = tolerance;
    if (!colors.is_none()) {
        if (!py::isinstance<VectorGridObject>(colors)) {
            throw Error(ErrorKind::Usage, "colors: expected a bandvox.VectorGrid");
        }
        options.colors = colors.cast<VectorGridObject&>().grid;
    }
    MeshResult result = inBackground(progress, threads, [&](Progress& watched) {
        return densityToMesh(grid, options, watched);
    });
    warn(result.warnings);
    auto mesh = std::make_shared<MeshObject>();
    mesh->surface = std::move(result.surface);
    mesh->name = grid->getName();
    return py::cast(mesh);
}

py::object toLevelSet(const py::object& object, const std::optional<double>& iso, double halfWidth,
                      int threads, const py::object& progress) {
    const auto grid = floatGridOf(object);
    LevelSetOptions options;
    options.iso = iso;
    options.halfWidth = halfWidth;
    LevelSetResult result = inBackground(progress, threads, [&](Progress& watched) {
        return densityToLevelSet(grid, options, watched);
    });
    return objectOf(result.grid);
}

py::tuple isoForVolume(const py::object& object, double volume, const py::object& progress) {
    const auto grid = floatGridOf(object);
    const VolumeIso found = inBackground(
        progress, 0, [&](Progress& watched) { return isoOfVolume(grid, volume, watched); });
    return py::make_tuple(found.iso, found.volume);
}

void bindReading(py::module_& module) {
    py::class_<ReconstructionObject>(module, "Reconstruction",
                                     R"(The continuous density that a grid's voxels stand for.

Reconstruction(grid, tolerance=1.5e-5, cache_bytes=2**29): by its own filter if the grid is a density
of this library, by a cubic B-spline otherwise. Safe to use from many threads.)")
        .def(py::init([](const py::object& grid, double tolerance, std::size_t cacheBytes) {
                 return std::make_unique<ReconstructionObject>(floatGridOf(grid), tolerance,
                                                               cacheBytes);
             }),
             py::arg("grid"), py::kw_only(), py::arg("tolerance") = 1.5e-5,
             py::arg("cache_bytes") = std::size_t(512) << 20)
        .def("value", &ReconstructionObject::value, py::arg("points"),
             "(n,) float64: the density at points of shape (n, 3), world units.")
        .def("gradient", &ReconstructionObject::gradient, py::arg("points"),
             "(n, 3) float64: its gradient there, per world unit.")
        .def("hessian", &ReconstructionObject::hessian, py::arg("points"),
             "(n, 3, 3) float64: its second derivatives there, per world unit squared.");
}

}  // namespace

void bindOperations(py::module_& module) {
    bindReading(module);
    const ResampleOptions resampling;
    module.def("resample", &resample, py::arg("grid"), py::kw_only(), py::arg("factor") = 0.0,
               py::arg("voxel_size") = 0.0, py::arg("onto") = py::none(), py::arg("filter") = true,
               py::arg("cutoff") = resampling.filter->cutoff,
               py::arg("order") = resampling.filter->order,
               py::arg("tolerance") = resampling.tolerance, py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(A grid on another lattice, filtered for it so that nothing aliases.

One of factor (voxels so many times as large), voxel_size (world units) and onto (a grid whose lattice
is taken). filter: False only reads between the voxels.)");
    module.def("detail_levels", &detailLevels, py::arg("grid"), py::arg("levels"), py::kw_only(),
               py::arg("threads") = 0, py::arg("progress") = py::none(),
               "A list of coarser copies, each with voxels twice as large, 1 to 16 of them.");
    module.def("merge", &merge, py::arg("grids"), py::kw_only(), py::arg("operation") = "union",
               py::arg("weights") = std::vector<double>{}, py::arg("clamp") = false,
               py::arg("threads") = 0, py::arg("progress") = py::none(),
               "Merges densities on one lattice: 'union', 'sum', 'max', 'blend', 'difference' or "
               "'intersection'. weights: of a sum or a blend, one for each.");
    module.def("compare", &compare, py::arg("a"), py::arg("b"), py::kw_only(),
               py::arg("surfaces") = true, py::arg("iso") = py::none(), py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(How far two grids are from each other, a dictionary.

maximum, rms, mean of the difference b - a; voxels; integrals. With surfaces: volumes, hausdorff and
mean_distance (world units), angle_mean and angle_95 of the normals (degrees).)");
    const MeshOptions meshing;
    module.def("to_mesh", &toMesh, py::arg("grid"), py::kw_only(), py::arg("iso") = py::none(),
               py::arg("adaptivity") = meshing.adaptivity, py::arg("tolerance") = meshing.tolerance,
               py::arg("colors") = py::none(), py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               "The closed surface {density = iso} as a Mesh with normals, and with colours if a "
               "VectorGrid of them is given.");
    module.def("to_level_set", &toLevelSet, py::arg("grid"), py::kw_only(),
               py::arg("iso") = py::none(), py::arg("half_width") = LevelSetOptions().halfWidth,
               py::arg("threads") = 0, py::arg("progress") = py::none(),
               "Signed distances from the surface, world units, in a narrow band of half_width "
               "voxels.");
    module.def("iso_of_volume", &isoForVolume, py::arg("grid"), py::arg("volume"), py::kw_only(),
               py::arg("progress") = py::none(),
               "The iso-value whose surface encloses a volume (world units cubed), and what it "
               "encloses.");
}

}  // namespace bandvox::python

// Grids on other lattices, and several grids in one.

#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "lattice_arguments.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/grid/join_shards.h>
#include <bandvox/grid/merge_grids.h>
#include <bandvox/grid/same_lattice.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/grid_to_density.h>
#include <bandvox/resample/cubic_lattice.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/resample/resample_grid.h>
#include <bandvox/resample/resample_vectors.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

openvdb::Vec3SGrid::Ptr vectorGridOf(const py::object& object) {
    if (!py::isinstance<VectorGridObject>(object)) return nullptr;
    return object.cast<VectorGridObject&>().grid;
}

// Filtered distances are none; those of the filtered solid are.
openvdb::FloatGrid::Ptr rebuiltLevelSet(const openvdb::FloatGrid::ConstPtr& grid,
                                        openvdb::math::Transform::Ptr target,
                                        const ResampleOptions& options, Progress& progress) {
    if (!hasCubicVoxels(*target)) {
        const openvdb::Vec3d size = target->voxelSize();
        target = cubicLattice(*grid, std::min({size[0], size[1], size[2]}));
    }
    GridDensityOptions solid{.source = grid->getName()};
    solid.density.filter = options.filter.value();
    solid.density.tolerance = options.tolerance;
    const DensityResult density = gridToDensity(grid, *target, solid, progress);
    const double width = std::round(grid->background() / grid->voxelSize()[0]);
    auto result =
        densityToLevelSet(density.grid, {.halfWidth = std::clamp(width, 1.0, 100.0)}, progress)
            .grid;
    result->setName(grid->getName());
    return result;
}

bool isLevelSet(const openvdb::FloatGrid& grid) {
    return grid.getGridClass() == openvdb::GRID_LEVEL_SET;
}

py::object resample(const py::object& object, const LatticeArguments& lattice,
                    const ResampleOptions& options, int threads, const py::object& progress) {
    if (lattice.count() != 1) {
        throw Error(ErrorKind::Usage,
                    "expected one of resolution, factor, voxel_size and onto, but got " +
                        std::to_string(lattice.count()));
    }
    const auto target = targetOf(*gridOf(object), lattice);
    if (const auto vectors = vectorGridOf(object)) {
        return objectOf(inBackground(progress, threads, [&](Progress& watched) {
            return resampleVectors(vectors, *target, options, watched);
        }));
    }
    const auto grid = floatGridOf(object);
    return objectOf(inBackground(progress, threads, [&](Progress& watched) {
        if (isLevelSet(*grid) && options.filter) {
            return rebuiltLevelSet(grid, target, options, watched);
        }
        return resampleGrid(grid, *target, options, watched).grid;
    }));
}

std::vector<openvdb::FloatGrid::Ptr> levelSetLevels(const openvdb::FloatGrid::ConstPtr& grid,
                                                    int levels, const ResampleOptions& options,
                                                    Progress& progress) {
    constexpr int kMostLevels = 16;
    if (levels < 1 || levels > kMostLevels) {
        throw Error(ErrorKind::Usage, "levels is " + std::to_string(levels) + "; expected 1 to 16");
    }
    std::vector<openvdb::FloatGrid::Ptr> made;
    for (int level = 1; level <= levels; ++level) {
        const auto target = grid->transform().copy();
        target->preScale(std::ldexp(1.0, level));
        made.push_back(rebuiltLevelSet(grid, target, options, progress));
        nameDetailLevel(*made.back(), *grid, level);
    }
    return made;
}

template <typename Grid>
py::list listOf(const std::vector<Grid>& grids) {
    py::list result;
    for (const auto& grid : grids) result.append(objectOf(grid));
    return result;
}

py::list detailLevels(const py::object& object, int levels, const ResampleOptions& options,
                      int threads, const py::object& progress) {
    if (const auto vectors = vectorGridOf(object)) {
        return listOf(inBackground(progress, threads, [&](Progress& watched) {
            return makeDetailLevels(openvdb::Vec3SGrid::ConstPtr(vectors), levels, options,
                                    watched);
        }));
    }
    const openvdb::FloatGrid::ConstPtr grid = floatGridOf(object);
    return listOf(inBackground(progress, threads, [&](Progress& watched) {
        if (isLevelSet(*grid)) return levelSetLevels(grid, levels, options, watched);
        return makeDetailLevels(grid, levels, options, watched);
    }));
}

/// The grid on the lattice of the first.
openvdb::FloatGrid::ConstPtr alignedTo(const openvdb::FloatGrid& first,
                                       const openvdb::FloatGrid::ConstPtr& grid,
                                       Progress& progress) {
    if (latticeDifference(first.transform(), grid->transform()).empty()) return grid;
    ResampleOptions options;
    // What is on the new lattice should be as it would have been made there: as the first was.
    if (const auto metadata = densityMetadata(first)) {
        options.filter = ExponentialFilter{metadata->order, metadata->cutoff};
    }
    return resampleGrid(grid, first.transform(), options, progress).grid;
}

py::object merge(const py::iterable& objects, const std::string& operation,
                 std::vector<double> weights, bool clamp, bool resamples, int threads,
                 const py::object& progress) {
    std::vector<openvdb::FloatGrid::ConstPtr> grids;
    for (const py::handle object : objects) {
        grids.push_back(floatGridOf(object));
        const std::string place = placeDifference(*grids.front(), *grids.back());
        if (place.empty()) continue;
        throw Error(ErrorKind::Input, "the grids are not in one world: " + place);
    }
    MergeOptions options;
    options.operation = static_cast<MergeOperation>(choiceOf(
        operation, {"union", "sum", "max", "blend", "difference", "intersection"}, "operation"));
    options.weights = std::move(weights);
    options.clamp = clamp;
    const MergeResult result = inBackground(progress, threads, [&](Progress& watched) {
        for (auto& grid : grids) {
            if (resamples) grid = alignedTo(*grids.front(), grid, watched);
        }
        return mergeGrids(grids, options, watched);
    });
    warn(result.warnings);
    return objectOf(result.grid);
}

py::object join(const py::iterable& objects, int threads, const py::object& progress) {
    std::vector<openvdb::GridBase::Ptr> parts;
    std::vector<std::string> names;
    for (const py::handle object : objects) {
        parts.push_back(gridOf(object));
        names.push_back("part " + std::to_string(parts.size()));
    }
    if (parts.empty()) throw Error(ErrorKind::Usage, "found no part; expected all of a grid");
    const JoinedGrid joined = inBackground(progress, threads, [&](Progress& watched) {
        // Parts are used up, and those of Python stay.
        for (auto& part : parts) {
            watched.throwIfInterrupted();
            part = part->deepCopyGrid();
        }
        return joinShards(parts, names, watched);
    });
    warn(joined.warnings);
    return objectOf(joined.grid);
}

void bindMerging(py::module_& module) {
    module.def("merge", &merge, py::arg("grids"), py::kw_only(), py::arg("operation") = "union",
               py::arg("weights") = std::vector<double>{}, py::arg("clamp") = false,
               py::arg("resample") = false, py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(Merges densities on the lattice of the first; a Grid.

operation: 'union', 'sum', 'max', 'blend', 'difference' or 'intersection'. weights: of a sum or a
blend, one for each. clamp: limit the result to 0 .. 1. resample: bring what is on another lattice
to that of the first; otherwise lattices may be whole voxels apart, no more.)");
    module.def("join_shards", &join, py::arg("grids"), py::kw_only(), py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               "The whole grid of all the parts that bandlimit(shard=(i, n)) has made, or `convert "
               "--shard`; they stay as they are. Raises InputError if one is missing.");
}

}  // namespace

void bindResample(py::module_& module) {
    bindMerging(module);
    const ResampleOptions standard;
    const ExponentialFilter filter = *standard.filter;
    module.def(
        "resample",
        [](const py::object& grid, int resolution, double factor, double voxelSize,
           const py::object& onto, bool isFiltered, double cutoff, double order, double tolerance,
           int threads, const py::object& progress) {
            ResampleOptions options;
            options.filter.reset();
            if (isFiltered) options.filter = ExponentialFilter{order, cutoff};
            options.tolerance = tolerance;
            return resample(grid, {resolution, voxelSize, factor, onto}, options, threads,
                            progress);
        },
        py::arg("grid"), py::kw_only(), py::arg("resolution") = 0, py::arg("factor") = 0.0,
        py::arg("voxel_size") = 0.0, py::arg("onto") = py::none(), py::arg("filter") = true,
        py::arg("cutoff") = filter.cutoff, py::arg("order") = filter.order,
        py::arg("tolerance") = standard.tolerance, py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(A Grid or a VectorGrid on another lattice, filtered for it so that nothing aliases.

One of resolution (voxels along the longest side), factor (voxels so many times as large),
voxel_size (world units) and onto (a grid whose lattice is taken). filter: False only reads between
the voxels. cutoff, order, tolerance: as of bandlimit; what a density has been filtered by counts.
Of a level set it is the distances of the solid that is filtered.)");
    module.def(
        "detail_levels",
        [](const py::object& grid, int levels, double cutoff, double order, double tolerance,
           int threads, const py::object& progress) {
            ResampleOptions options;
            options.filter = ExponentialFilter{order, cutoff};
            options.tolerance = tolerance;
            return detailLevels(grid, levels, options, threads, progress);
        },
        py::arg("grid"), py::arg("levels"), py::kw_only(), py::arg("cutoff") = filter.cutoff,
        py::arg("order") = filter.order, py::arg("tolerance") = standard.tolerance,
        py::arg("threads") = 0, py::arg("progress") = py::none(),
        "A list of coarser copies of a Grid or a VectorGrid, each with voxels twice as large, 1 to "
        "16 of them. The others are those of resample.");
}

}  // namespace bandvox::python

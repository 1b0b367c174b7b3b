// The solid that a grid stands for: as a band-limited density, a level set, fog, a mesh.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "density_request.h"
#include "errors.h"
#include "grid_object.h"
#include "lattice_arguments.h"
#include "mesh_object.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/grid_to_density.h>
#include <bandvox/mesh/iso_of_volume.h>
#include <bandvox/resample/cubic_lattice.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using Threshold = std::variant<double, std::array<double, 2>>;

/// Above 0 where values are between the two: min(v - low, high - v).
openvdb::FloatGrid::Ptr between(const openvdb::FloatGrid& grid, const std::array<double, 2>& two) {
    const auto inside = [&](float v) {
        return static_cast<float>(std::min(v - two[0], two[1] - v));
    };
    openvdb::FloatGrid::Ptr result = grid.deepCopy();
    openvdb::FloatTree& tree = result->tree();
    tree.root().setBackground(inside(grid.background()), false);
    auto tile = tree.beginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(inside(*tile));
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        float* const values = leaf->buffer().data();
        std::transform(values, values + openvdb::FloatTree::LeafNodeType::SIZE, values, inside);
    }
    // It is a density, or another thing, no more.
    result->clearMetadata();
    result->setName(grid.getName());
    setPlaceMetadata(*result, placeMetadata(grid));
    return result;
}

/// A grid, the value that is the surface of its solid, and what it was made from.
struct GridSolid {
    openvdb::FloatGrid::ConstPtr grid;
    std::optional<double> iso;
    std::string name;
};

GridSolid solidOf(const openvdb::FloatGrid::Ptr& grid, const std::optional<Threshold>& threshold) {
    GridSolid solid{grid, {}, sourceOf(*grid)};
    if (solid.name.empty()) solid.name = grid->getName();
    if (!threshold) return solid;
    const double background = grid->background();
    if (const double* one = std::get_if<double>(&*threshold)) {
        solid.iso = *one;
        if (*one > background || grid->getGridClass() == openvdb::GRID_LEVEL_SET) return solid;
        throw Error(ErrorKind::Usage, "threshold is " + std::to_string(*one) +
                                          "; expected a number above the background of the grid, " +
                                          std::to_string(background));
    }
    const auto& two = std::get<std::array<double, 2>>(*threshold);
    if (!(two[0] < two[1]) || (background >= two[0] && background <= two[1])) {
        throw Error(ErrorKind::Usage, "threshold is " + std::to_string(two[0]) + " to " +
                                          std::to_string(two[1]) +
                                          "; expected the lower number first, and the background "
                                          "of the grid, " +
                                          std::to_string(background) + ", not between them");
    }
    solid.grid = between(*grid, two);
    solid.iso = 0;
    return solid;
}

py::object bandlimitGrid(const py::object& object, const std::optional<Threshold>& threshold,
                         const LatticeArguments& lattice, const DensityRequest& request) {
    const auto grid = floatGridOf(object);
    if (!threshold && isDensityOfSolid(*grid)) {
        throw Error(ErrorKind::Usage,
                    "the grid '" + grid->getName() +
                        "' is a band-limited density already; expected another one, a threshold, "
                        "or resample for another lattice");
    }
    auto target = targetOf(*grid, lattice);
    if (!hasCubicVoxels(*target)) {
        if (!lattice.onto.is_none()) {
            throw Error(ErrorKind::Usage,
                        "onto has voxels that are no cubes, which a solid needs; "
                        "expected another grid, or voxel_size");
        }
        const openvdb::Vec3d size = target->voxelSize();
        target = cubicLattice(*grid, std::min({size[0], size[1], size[2]}));
    }
    return madeDensity(request, [&](Progress& progress) {
        const GridSolid solid = solidOf(grid, threshold);
        return gridToDensity(solid.grid, *target, {request.options, solid.iso, solid.name},
                             progress);
    });
}

py::object toMesh(const py::object& object, const py::object& iso, double adaptivity,
                  double tolerance, const py::object& colors, int threads,
                  const py::object& progress) {
    const auto grid = floatGridOf(object);
    const IsoArgument asked = isoArgumentOf(iso);
    MeshOptions options;
    options.adaptivity = adaptivity;
    options.tolerance = tolerance;
    if (!colors.is_none()) {
        if (!py::isinstance<VectorGridObject>(colors)) {
            throw Error(ErrorKind::Usage, "colors: expected a bandvox.VectorGrid");
        }
        options.colors = colors.cast<VectorGridObject&>().grid;
    }
    MeshResult result = inBackground(progress, threads, [&](Progress& watched) {
        options.iso = isoFor(asked, grid, watched);
        return densityToMesh(grid, options, watched);
    });
    warn(result.warnings);
    auto mesh = std::make_shared<MeshObject>();
    mesh->surface = std::move(result.surface);
    mesh->name = grid->getName();
    return py::cast(mesh);
}

/// What makes a grid of a level set, which is used up.
using FromLevelSet = std::function<openvdb::FloatGrid::Ptr(const openvdb::FloatGrid::Ptr&)>;

py::object ofLevelSet(const py::object& object, const py::object& iso, double band, int threads,
                      const py::object& progress, const FromLevelSet& make) {
    const auto grid = floatGridOf(object);
    const IsoArgument asked = isoArgumentOf(iso);
    return objectOf(inBackground(progress, threads, [&](Progress& watched) {
        return make(densityToLevelSet(grid, {isoFor(asked, grid, watched), band}, watched).grid);
    }));
}

py::tuple isoForVolume(const py::object& object, double volume, const py::object& progress) {
    const auto grid = floatGridOf(object);
    const VolumeIso found = inBackground(
        progress, 0, [&](Progress& watched) { return isoOfVolume(grid, volume, watched); });
    return py::make_tuple(found.iso, found.volume);
}

void bindBandlimitGrid(py::module_& module) {
    const DensityOptions standard;
    module.def(
        "bandlimit_grid",
        [](const py::object& grid, const std::optional<Threshold>& threshold, int resolution,
           double voxelSize, double factor, const py::object& onto, double cutoff, double order,
           const std::optional<double>& tolerance, int tile, bool clamp, const py::object& iso,
           const py::object& shard, int threads, const py::object& progress) {
            DensityRequest request =
                densityRequestOf({cutoff, order, tile, clamp}, tolerance, iso, threads, progress);
            request.options.shard = shardOf(shard);
            return bandlimitGrid(grid, threshold, {resolution, voxelSize, factor, onto}, request);
        },
        py::arg("grid"), py::kw_only(), py::arg("threshold") = py::none(),
        py::arg("resolution") = 0, py::arg("voxel_size") = 0.0, py::arg("factor") = 0.0,
        py::arg("onto") = py::none(), py::arg("cutoff") = standard.filter.cutoff,
        py::arg("order") = standard.filter.order, py::arg("tolerance") = py::none(),
        py::arg("tile") = 0, py::arg("clamp") = false, py::arg("iso") = standard.iso,
        py::arg("shard") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
        R"(Turns the solid that a grid stands for into a band-limited density, a Grid.

grid: a level set, fog, a MaskGrid, a scan. threshold: values above it are inside, or those between
two, (low, high); by default what the grid says, else 0.5, and below 0 of a level set. At most one of
resolution (voxels along the longest side), voxel_size (world units), factor (voxels so many times
as large) and onto (a grid whose lattice is taken), by default the grid's own lattice, or cubes along
it. The others are those of bandlimit; iso is that of the density.)");
}

}  // namespace

void bindGridSolids(py::module_& module) {
    bindBandlimitGrid(module);
    const MeshOptions meshing;
    module.def("to_mesh", &toMesh, py::arg("grid"), py::kw_only(), py::arg("iso") = py::none(),
               py::arg("adaptivity") = meshing.adaptivity, py::arg("tolerance") = meshing.tolerance,
               py::arg("colors") = py::none(), py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(The closed surface {density = iso} as a Mesh with normals.

iso: by default what the grid says, else 0.5, and 0 of a level set; 'volume' takes the value that
encloses the volume of the source. adaptivity: 0 to 1, leaves points out where the surface hardly
bends. tolerance: distance of points from the surface, voxels, 1e-5 to 0.1. colors: a VectorGrid
that the mesh takes its colours from.)");
    const double band = LevelSetOptions().halfWidth;
    module.def(
        "to_level_set",
        [](const py::object& grid, const py::object& iso, double width, int threads,
           const py::object& progress) {
            return ofLevelSet(grid, iso, width, threads, progress,
                              [](const openvdb::FloatGrid::Ptr& levelSet) { return levelSet; });
        },
        py::arg("grid"), py::kw_only(), py::arg("iso") = py::none(), py::arg("band") = band,
        py::arg("threads") = 0, py::arg("progress") = py::none(),
        "Signed distances from the surface, world units, in a band around it. iso: as of to_mesh. "
        "band: half of its width, voxels, 1 to 100.");
    module.def(
        "to_fog",
        [](const py::object& grid, const py::object& iso, double width, int threads,
           const py::object& progress) {
            return ofLevelSet(grid, iso, width, threads, progress, &levelSetToFog);
        },
        py::arg("grid"), py::kw_only(), py::arg("iso") = py::none(), py::arg("band") = band,
        py::arg("threads") = 0, py::arg("progress") = py::none(),
        "Fog as OpenVDB makes it of distances: 0 on the surface, 1 inside from a depth of band on. "
        "iso, band: as of to_level_set.");
    module.def("iso_of_volume", &isoForVolume, py::arg("grid"), py::arg("volume"), py::kw_only(),
               py::arg("progress") = py::none(),
               "The iso-value whose surface encloses a volume (world units cubed), and what it "
               "encloses.");
}

}  // namespace bandvox::python

// Grids to and from .vdb files, and what Python has for each type of them.

#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "grid_object.h"
#include "words.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/write_usd_volume.h>
#include <bandvox/voxelize/voxels.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace bandvox::python {

namespace py = pybind11;

namespace {

py::list readGrids(const std::filesystem::path& path, int threads, const py::object& progress) {
    const openvdb::GridPtrVec grids =
        inBackground(progress, threads, [&](Progress& watched) { return readVdb(path, watched); });
    py::list result;
    for (const auto& grid : grids) {
        if (py::object object = objectOf(grid); !object.is_none()) result.append(object);
    }
    return result;
}

void writeGrids(const std::filesystem::path& path, const py::iterable& objects, bool isHalf,
                const std::string& compression, int threads, const py::object& progress) {
    openvdb::GridCPtrVec grids;
    for (const py::handle object : objects) grids.push_back(gridOf(object));
    const VdbWriteOptions options = vdbOptions(isHalf, compression);
    runInBackground([&](Progress& watched) { writeGridFiles(path, grids, options, watched); },
                    progress, threads);
}

/// Grids of other numbers as floats; null for what is none.
openvdb::FloatGrid::Ptr floatsOf(const openvdb::GridBase::Ptr& grid) {
    openvdb::FloatGrid::Ptr floats;
    if (auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid)) {
        floats = std::make_shared<openvdb::FloatGrid>(*doubles);
    } else if (auto whole = openvdb::gridPtrCast<openvdb::Int32Grid>(grid)) {
        floats = std::make_shared<openvdb::FloatGrid>(*whole);
    }
    return floats;
}

/// Grids of truths, and of nothing but their topology.
openvdb::BoolGrid::Ptr truthsOf(const openvdb::GridBase::Ptr& grid) {
    if (auto bools = openvdb::gridPtrCast<openvdb::BoolGrid>(grid)) return bools;
    const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(grid);
    if (!mask) return nullptr;
    auto bools = openvdb::BoolGrid::create(
        std::make_shared<openvdb::BoolTree>(mask->tree(), false, true, openvdb::TopologyCopy()));
    bools->setTransform(mask->transformPtr());
    static_cast<openvdb::MetaMap&>(*bools) = static_cast<const openvdb::MetaMap&>(*mask);
    return bools;
}

}  // namespace

void writeGridFiles(const std::filesystem::path& path, openvdb::GridCPtrVec grids,
                    const VdbWriteOptions& options, Progress& progress) {
    const std::string ending = app::lowerCase(path.extension().string());
    if (ending != ".vdb" && ending != ".usda") {
        throw Error(ErrorKind::Usage,
                    "path is '" + path.string() + "'; expected a .vdb or a .usda file");
    }
    // What densities say of themselves has to hold for what is in the file.
    for (openvdb::GridBase::ConstPtr& grid : grids) {
        if (!options.half || !densityMetadata(*grid)) continue;
        const auto rounded = openvdb::gridPtrCast<openvdb::FloatGrid>(grid->deepCopyGrid());
        if (!rounded) continue;
        roundAndRestate(*rounded, progress);
        grid = rounded;
    }
    if (ending == ".vdb") return writeVdb(path, grids, options, progress);
    AtomicFile usd(path);
    AtomicFile volume(std::filesystem::path(path).replace_extension(".vdb"));
    writeUsdVolume(usd, volume.target().filename().string(), grids, options.half);
    writeVdb(volume, grids, options, progress);
    progress.throwIfInterrupted();
    // The volume gets its name first: nothing ever refers to one that is not there.
    volume.commit();
    usd.commit();
}

VdbWriteOptions vdbOptions(bool isHalf, const std::string& compression) {
    VdbWriteOptions options{.half = isHalf};
    options.compression = static_cast<VdbWriteOptions::Compression>(
        choiceOf(compression, {"blosc", "zip", "none"}, "compression"));
    return options;
}

py::object objectOf(const openvdb::GridBase::Ptr& grid) {
    if (auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) {
        return py::cast(std::make_shared<FloatGridObject>(FloatGridObject{floats}));
    }
    if (auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid)) {
        return py::cast(std::make_shared<VectorGridObject>(VectorGridObject{vectors}));
    }
    if (auto masks = truthsOf(grid)) {
        return py::cast(std::make_shared<MaskGridObject>(MaskGridObject{masks}));
    }
    if (auto floats = floatsOf(grid)) {
        return py::cast(std::make_shared<FloatGridObject>(FloatGridObject{floats}));
    }
    return py::none();
}

openvdb::FloatGrid::Ptr floatGridOf(const py::handle& object) {
    if (py::isinstance<FloatGridObject>(object)) return object.cast<FloatGridObject&>().grid;
    if (py::isinstance<MaskGridObject>(object)) {
        return maskToVoxels(*object.cast<MaskGridObject&>().grid);
    }
    throw Error(ErrorKind::Usage, std::string("found a ") + Py_TYPE(object.ptr())->tp_name +
                                      "; expected a bandvox.Grid");
}

openvdb::GridBase::Ptr gridOf(const py::handle& object) {
    if (py::isinstance<VectorGridObject>(object)) return object.cast<VectorGridObject&>().grid;
    if (py::isinstance<MaskGridObject>(object)) return object.cast<MaskGridObject&>().grid;
    return floatGridOf(object);
}

void bindGridFiles(py::module_& module) {
    module.def("read_vdb", &readGrids, py::arg("path"), py::kw_only(), py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               "The grids of a .vdb file, a list: of floats, doubles and whole numbers as Grid, of "
               "vec3s as VectorGrid, of bools as MaskGrid; others are left out. Raises InputError "
               "for files that are none.");
    module.def("write_vdb", &writeGrids, py::arg("path"), py::arg("grids"), py::kw_only(),
               py::arg("half") = false, py::arg("compression") = "blosc", py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(Writes grids to a .vdb file, whole or not at all.

A path that ends in .usda gets a USD volume that refers to a .vdb file of its name, which is written
beside it. half: 16-bit values, which changes densities by up to 2.5e-4, above 1 by 5e-4.
compression: 'blosc', 'zip' or 'none'.)");
}

}  // namespace bandvox::python

// What files, grids and meshes are, in a dictionary, or to look at in a browser.

#include "background.h"
#include "bindings.h"
#include "errors.h"
#include "grid_object.h"
#include "patches_object.h"
#include "paths.h"
#include "solid_mesh.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>

#include <grid_report.h>
#include <mesh_report.h>
#include <nlohmann/json.hpp>
#include <patch_report.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <view_page.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using Json = nlohmann::ordered_json;

py::object objectOf(const Json& json) {
    const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    return py::module_::import("json").attr("loads")(text);
}

Json fileReport(const std::filesystem::path& path, Progress& progress) {
    if (isPatchFile(path)) return app::patchReport(path.string(), progress);
    if (isMeshFile(path)) return app::meshReport(path.string(), progress);
    const openvdb::GridPtrVec grids = readVdb(path, progress);
    Json report;
    report["file"] = path.string();
    report["file_bytes"] = std::filesystem::file_size(path);
    report["grids"] = Json::array();
    for (const auto& grid : grids) report["grids"].push_back(app::gridReport(*grid));
    return report;
}

py::object info(const py::object& source, int threads, const py::object& progress) {
    if (isPath(source)) {
        const auto path = pathOf(source);
        return objectOf(inBackground(progress, threads,
                                     [&](Progress& watched) { return fileReport(path, watched); }));
    }
    if (py::isinstance<PatchesObject>(source)) {
        PatchModel model = source.cast<const PatchesObject&>().model;
        return objectOf(inBackground(progress, threads, [&](Progress& watched) {
            return app::patchReport(std::move(model), watched);
        }));
    }
    if (const auto mesh = meshOf(source)) {
        return objectOf(inBackground(progress, threads, [&](Progress& watched) {
            return app::meshReport(MeshFile{mesh->surface.mesh, 1, {}}, watched);
        }));
    }
    return objectOf(app::gridReport(*gridOf(source)));
}

void writePage(const std::filesystem::path& path, const std::string& html) {
    AtomicFile file(path);
    std::ofstream out = file.open();
    out.write(html.data(), static_cast<std::streamsize>(html.size()));
    out.close();
    if (!out) {
        throw Error(ErrorKind::Runtime,
                    "cannot write the page to '" + path.string() + "': " + std::strerror(errno));
    }
    file.commit();
}

void view(const std::filesystem::path& path, const py::object& grid,
          const std::optional<std::string>& title, const std::optional<double>& iso, int size,
          int threads, const py::object& progress) {
    if (path.extension() != ".html") {
        throw Error(ErrorKind::Usage, "path is '" + path.string() + "'; expected an .html file");
    }
    if (size < app::kLeastViewSize || size > app::kMostViewSize) {
        throw Error(ErrorKind::Usage, "size is " + std::to_string(size) + "; expected " +
                                          std::to_string(app::kLeastViewSize) + " to " +
                                          std::to_string(app::kMostViewSize));
    }
    app::ViewPage page;
    page.grid = floatGridOf(grid);
    page.title = title.value_or(page.grid->getName());
    page.file = page.grid->getName();
    runInBackground([&](Progress& watched) { app::summarizeGrid(page, iso, size, watched); },
                    progress, threads);
    // A warning that is made an error has to come before the file.
    warn(app::doubtsAbout(page));
    runInBackground([&](Progress& watched) { writePage(path, app::viewHtml(page, watched)); },
                    progress, threads);
}

}  // namespace

void bindReports(py::module_& module) {
    module.def(
        "info", &info, py::arg("source"), py::kw_only(), py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(What a .vdb file, a mesh file, one of free-form surfaces, a grid, a Mesh or Patches are, a
dictionary as `bandvox info --json` prints it.

Of grids size, voxels, class, type and metadata; of meshes and patches the holes and whatever else
keeps them from being the boundary of a solid, and the volume and area of the solid that is made of
them.)");
    module.def("view", &view, py::arg("path"), py::arg("grid"), py::kw_only(),
               py::arg("title") = py::none(), py::arg("iso") = py::none(),
               py::arg("size") = app::kViewSize, py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(Writes an .html page that shows a grid, to look at in a browser, without anything
beside it.

iso: the value that is the surface at first, by default as stored, else 0.5, or 0 of a level set.
size: samples along the longest side, 16 to 512.)");
}

}  // namespace bandvox::python

// The module bandvox._bandvox, which the package bandvox is made of.

#include "bindings.h"
#include "errors.h"
#include "grid_object.h"
#include "mesh_object.h"
#include "patches_object.h"

#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>

#include <openvdb/openvdb.h>

PYBIND11_MODULE(_bandvox, module) {
    using namespace bandvox::python;
    openvdb::initialize();
    module.doc() = "Shapes to band-limited OpenVDB volumes, and pictures of them.";
    module.attr("__version__") = bandvox::version();
    bindErrors(module);
    bindMesh(module);
    bindGrids(module);
    bindGridFiles(module);
    bindArrays(module);
    bindReconstruction(module);
    bindGridSolids(module);
    bindResample(module);
    bindCompare(module);
    bindReports(module);
    bindRender(module);
    bindPatches(module);
    bindBandlimit(module);
    bindPoints(module);
    bindOutline(module);
    bindFit(module);
    bindFitVolume(module);
    bindVoxelize(module);
    module.def("thread_count", &bandvox::threadCount, "How many threads work at most.");
}

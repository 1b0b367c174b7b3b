#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/openvdb.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <string>

namespace bandvox::python {

/// A grid of Python. It is no OpenVDB class to pybind11, so that OpenVDB's own module may bind
/// those.
template <typename Grid>
struct GridObject {
    typename Grid::Ptr grid;
};

using FloatGridObject = GridObject<openvdb::FloatGrid>;
using VectorGridObject = GridObject<openvdb::Vec3SGrid>;
using MaskGridObject = GridObject<openvdb::BoolGrid>;

/// The object for a grid, one of other numbers as floats; None for one of a type that there is none
/// for.
pybind11::object objectOf(const openvdb::GridBase::Ptr& grid);

/// What of a Python object is a grid of numbers, a mask as 1 where it is active; or of any kind.
/// Throws Error(ErrorKind::Usage).
openvdb::FloatGrid::Ptr floatGridOf(const pybind11::handle& object);
openvdb::GridBase::Ptr gridOf(const pybind11::handle& object);

/// compression: as `--compression` says it. Throws Error(ErrorKind::Usage) for another word.
VdbWriteOptions vdbOptions(bool isHalf, const std::string& compression);

/// Writes grids to a .vdb file, or to a .usda file and the .vdb file that it refers to. Throws as
/// writeVdb and writeUsdVolume.
void writeGridFiles(const std::filesystem::path& path, openvdb::GridCPtrVec grids,
                    const VdbWriteOptions& options, Progress& progress);

void bindGrids(pybind11::module_& module);

}  // namespace bandvox::python

#pragma once

#include <openvdb/openvdb.h>
#include <pybind11/pybind11.h>

#include <memory>

namespace bandvox::python {

/// A grid of Python. It is no OpenVDB class to pybind11, so that OpenVDB's own module may bind
/// those.
template <typename Grid>
struct GridObject {
    typename Grid::Ptr grid;
};

using FloatGridObject = GridObject<openvdb::FloatGrid>;
using VectorGridObject = GridObject<openvdb::Vec3SGrid>;

/// The object for a grid; None for one of a type that there is none for.
pybind11::object objectOf(const openvdb::GridBase::Ptr& grid);

/// What of a Python object is a grid of numbers, or of any kind. Throws Error(ErrorKind::Usage).
openvdb::FloatGrid::Ptr floatGridOf(const pybind11::handle& object);
openvdb::GridBase::Ptr gridOf(const pybind11::handle& object);

void bindGrids(pybind11::module_& module);

}  // namespace bandvox::python

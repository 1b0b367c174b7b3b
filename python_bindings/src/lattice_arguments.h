#pragma once

#include <openvdb/openvdb.h>
#include <pybind11/pybind11.h>

namespace bandvox::python {

/// The lattice that a grid is brought to, as functions of Python take it: one of these, or none.
struct LatticeArguments {
    int resolution = 0;     ///< voxels along the longest side; 0: not asked for
    double voxelSize = 0;   ///< world units; the same
    double factor = 0;      ///< voxels so many times as large; the same
    pybind11::object onto;  ///< a grid whose lattice is taken, or None

    int count() const {
        return (resolution != 0) + (voxelSize != 0) + (factor != 0) + !onto.is_none();
    }
};

/// The lattice for a grid; its own if nothing is asked for. Throws Error(ErrorKind::Usage) for
/// several at a time and sizes that are none, Error(ErrorKind::Input) if `onto` says that it lies
/// in another world.
openvdb::math::Transform::Ptr targetOf(const openvdb::GridBase& grid,
                                       const LatticeArguments& lattice);

}  // namespace bandvox::python

// Grids: to and from arrays and pickles.

#include "arrays.h"
#include "background.h"
#include "grid_object.h"
#include "text.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Stream.h>
#include <openvdb/tools/Dense.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

openvdb::Mat4d rowsOf(const openvdb::GridBase& grid) {
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Input, "the grid '" + grid.getName() +
                                          "' has a transform that is not linear, so no matrix");
    }
    return grid.transform().baseMap()->getAffineMap()->getMat4();
}

py::object valueOf(const openvdb::Metadata& metadata) {
    const auto typed = [&](auto example) -> py::object {
        using Value = decltype(example);
        const auto* found = dynamic_cast<const openvdb::TypedMetadata<Value>*>(&metadata);
        return found ? py::cast(found->value()) : py::object();
    };
    if (metadata.typeName() == openvdb::StringMetadata::staticTypeName()) {
        return textOf(metadata.str());
    }
    if (auto value = typed(bool())) return value;
    if (auto value = typed(double())) return value;
    if (auto value = typed(float())) return value;
    if (auto value = typed(openvdb::Int32())) return value;
    if (auto value = typed(openvdb::Int64())) return value;
    return textOf(metadata.str());
}

py::dict metadataOf(const openvdb::GridBase& grid) {
    py::dict all;
    for (auto it = grid.beginMeta(); it != grid.endMeta(); ++it) {
        all[textOf(it->first)] = valueOf(*it->second);
    }
    return all;
}

Coord coordOf(const py::handle& object, const char* what) {
    const openvdb::Vec3d place = vectorOf(object, what);
    constexpr double kFarthest = 1 << 30;
    Coord result;
    for (int axis = 0; axis < 3; ++axis) {
        if (place[axis] != std::floor(place[axis]) || std::abs(place[axis]) > kFarthest) {
            throw Error(ErrorKind::Usage, std::string(what) + ": found " +
                                              std::to_string(place[axis]) +
                                              "; expected whole numbers of voxels, 2**30 at most");
        }
        result[axis] = static_cast<int>(place[axis]);
    }
    return result;
}

py::tuple tupleOf(const Coord& place) {
    return py::make_tuple(place[0], place[1], place[2]);
}

CoordBBox boxOf(const openvdb::GridBase& grid, const py::object& bounds) {
    if (!bounds.is_none()) {
        const auto two = bounds.cast<py::sequence>();
        if (two.size() != 2) {
            throw Error(ErrorKind::Usage, "bounds: found " + std::to_string(two.size()) +
                                              " places; expected the first voxel and the last");
        }
        const CoordBBox box(coordOf(two[0], "bounds"), coordOf(two[1], "bounds"));
        if (!box.empty()) return box;
        throw Error(ErrorKind::Usage,
                    "bounds hold no voxel; expected the first one before the last");
    }
    const CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (!box.empty()) return box;
    throw Error(ErrorKind::Result, "the grid '" + grid.getName() + "' has no active voxel");
}

template <typename Grid>
constexpr bool kIsVector = std::is_same_v<Grid, openvdb::Vec3SGrid>;
template <typename Grid>
constexpr bool kIsMask = std::is_same_v<Grid, openvdb::BoolGrid>;

/// What arrays of a grid's values are made of.
template <typename Grid>
using NumberOf = std::conditional_t<kIsMask<Grid>, bool, float>;

/// The values of a box as [x][y][z], or [x][y][z][3], and its first voxel.
template <typename Grid>
py::tuple toArray(const GridObject<Grid>& object, const py::object& bounds) {
    const Grid& grid = *object.grid;
    const CoordBBox box = boxOf(grid, bounds);
    const Coord size = box.dim();
    constexpr double kMost = double(1) * (1 << 30) * 16;
    if (double(size[0]) * size[1] * size[2] > kMost) {
        throw Error(ErrorKind::Memory, "an array of " + std::to_string(size[0]) + " x " +
                                           std::to_string(size[1]) + " x " +
                                           std::to_string(size[2]) +
                                           " voxels would be too large; expected smaller bounds");
    }
    std::vector<py::ssize_t> shape{size[0], size[1], size[2]};
    if (kIsVector<Grid>) shape.push_back(3);
    py::array_t<NumberOf<Grid>> array(shape);
    auto* values = reinterpret_cast<typename Grid::ValueType*>(array.mutable_data());
    {
        const py::gil_scoped_release unlocked;
        openvdb::tools::Dense<typename Grid::ValueType, openvdb::tools::LayoutZYX> dense(box,
                                                                                         values);
        openvdb::tools::copyToDense(grid, dense);
    }
    return py::make_tuple(array, tupleOf(box.min()));
}

/// Throws Error(ErrorKind::Usage), which says where, if there is one that is not finite.
void requireNumbers(const py::array_t<float>& values) {
    const float* first = values.data();
    const float* const end = first + values.size();
    const float* const found = std::find_if(first, end, [](float x) { return !std::isfinite(x); });
    if (found == end) return;
    auto left = static_cast<py::ssize_t>(found - first);
    std::string place;
    for (py::ssize_t axis = values.ndim() - 1; axis >= 0; --axis) {
        place = std::to_string(left % values.shape(axis)) + (place.empty() ? "" : ", ") + place;
        left /= values.shape(axis);
    }
    const std::string isWhat = std::isnan(*found) ? "nan" : "a number beyond those of float32";
    throw Error(ErrorKind::Usage,
                "array: found " + isWhat + " at [" + place +
                    "]; expected finite numbers of float32, as numpy.nan_to_num and numpy.clip "
                    "make them");
}

/// A grid of an array: what differs from the background by no more than the tolerance is not kept.
template <typename Grid>
std::shared_ptr<GridObject<Grid>> fromArray(const py::object& array, const py::object& origin,
                                            const py::object& voxelSize,
                                            const py::object& transform, double background,
                                            double tolerance, const std::string& name) {
    using Value = typename Grid::ValueType;
    auto object = std::make_shared<GridObject<Grid>>();
    object->grid = Grid::create(Value(static_cast<NumberOf<Grid>>(background)));
    constexpr bool isVector = kIsVector<Grid>;
    const py::ssize_t axes = isVector ? 4 : 3;
    const std::string expected =
        isVector ? "numbers of shape (x, y, z, 3)" : "numbers of shape (x, y, z)";
    const py::array given = anyArray(array, "array", expected);
    const char kind = given.dtype().kind();
    const bool isNumeric = kind == 'f' || kind == 'i' || kind == 'u' || kind == 'b';
    if (given.ndim() != axes || (isVector && given.shape(3) != 3) || !isNumeric ||
        given.size() == 0) {
        throw Error(ErrorKind::Usage,
                    "array: found " + described(given) + "; expected " + expected);
    }
    if (!(tolerance >= 0) || !std::isfinite(static_cast<float>(background))) {
        throw Error(ErrorKind::Usage, "found the tolerance " + std::to_string(tolerance) +
                                          " and the background " + std::to_string(background) +
                                          "; expected a tolerance of 0 or more, and a background "
                                          "that is finite");
    }
    if (!voxelSize.is_none() && !transform.is_none()) {
        throw Error(ErrorKind::Usage, "voxel_size and transform exclude each other");
    }
    // C-ordered floats are taken where they lie.
    const auto values =
        py::array_t<NumberOf<Grid>, py::array::c_style | py::array::forcecast>::ensure(given);
    const Coord first = origin.is_none() ? Coord(0) : coordOf(origin, "origin");
    const CoordBBox box(first, first.offsetBy(static_cast<int>(values.shape(0)) - 1,
                                              static_cast<int>(values.shape(1)) - 1,
                                              static_cast<int>(values.shape(2)) - 1));
    auto& grid = *object->grid;
    grid.setName(name);
    if (!transform.is_none()) {
        grid.setTransform(openvdb::math::Transform::createLinearTransform(transformOf(transform)));
    } else if (!voxelSize.is_none()) {
        const openvdb::Vec3d side = vectorOf(voxelSize, "voxel_size");
        if (!(side[0] > 0 && side[1] > 0 && side[2] > 0 && std::isfinite(side.length()))) {
            throw Error(ErrorKind::Usage, "voxel_size: expected finite numbers above 0");
        }
        constexpr double kSmallestVolume = 3e-15;  // that OpenVDB can invert
        if (side[0] * side[1] * side[2] < kSmallestVolume) {
            throw Error(ErrorKind::Usage,
                        "voxel_size: found voxels of a volume below 3e-15, which OpenVDB does not "
                        "take; expected larger ones, as of another unit");
        }
        grid.transform().postScale(side);
    }
    if constexpr (!kIsMask<Grid>) requireNumbers(values);
    auto* data = reinterpret_cast<Value*>(const_cast<NumberOf<Grid>*>(values.data()));
    const py::gil_scoped_release unlocked;
    openvdb::tools::Dense<Value, openvdb::tools::LayoutZYX> dense(box, data);
    openvdb::tools::copyFromDense(dense, grid, Value(static_cast<NumberOf<Grid>>(tolerance)));
    return object;
}

py::bytes bytesOf(const openvdb::GridBase::Ptr& grid) {
    std::ostringstream stream(std::ios::binary);
    openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{grid});
    return py::bytes(stream.str());
}

openvdb::GridBase::Ptr gridOfBytes(const py::bytes& bytes) {
    std::istringstream stream(std::string(bytes), std::ios::binary);
    openvdb::GridPtrVec grids = readVdb(stream, "the pickle");
    if (grids.size() != 1) throw Error(ErrorKind::Input, "the pickle holds no grid");
    return grids.front();
}

/// The blocks of 8 x 8 x 8 voxels that a grid keeps, one after another.
template <typename Grid>
struct Blocks {
    typename Grid::Ptr grid;
    typename Grid::TreeType::LeafCIter next;
};

template <typename Grid>
py::tuple nextBlock(const py::object& self) {
    auto& blocks = self.cast<Blocks<Grid>&>();
    if (!blocks.next) throw py::stop_iteration();
    const auto& leaf = *blocks.next;
    constexpr py::ssize_t kSide = Grid::TreeType::LeafNodeType::DIM;
    std::vector<py::ssize_t> shape{kSide, kSide, kSide};
    if (kIsVector<Grid>) shape.push_back(3);
    py::array view;
    if constexpr (kIsMask<Grid>) {
        // Its values are bits.
        py::array_t<bool> copied(shape);
        bool* to = copied.mutable_data();
        for (openvdb::Index i = 0; i < Grid::TreeType::LeafNodeType::SIZE; ++i) {
            to[i] = leaf.getValue(i);
        }
        view = std::move(copied);
    } else {
        // The iterator keeps the grid.
        view =
            py::array_t<float>(shape, reinterpret_cast<const float*>(leaf.buffer().data()), self);
    }
    py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    const py::tuple result = py::make_tuple(tupleOf(leaf.origin()), view);
    ++blocks.next;
    return result;
}

template <typename Grid>
void bindGrid(py::module_& module, const char* name, const char* doc) {
    using Object = GridObject<Grid>;
    const std::string blocksName = std::string("_") + name + "Blocks";
    py::class_<Blocks<Grid>>(module, blocksName.c_str())
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &nextBlock<Grid>);

    py::class_<Object, std::shared_ptr<Object>>(module, name, doc)
        .def_static("from_array", &fromArray<Grid>, py::arg("array"), py::kw_only(),
                    py::arg("origin") = py::none(), py::arg("voxel_size") = py::none(),
                    py::arg("transform") = py::none(), py::arg("background") = 0.0,
                    py::arg("tolerance") = 0.0, py::arg("name") = "density",
                    R"(A sparse grid of a dense array, indexed [x, y, z].

origin: index of the array's first voxel, (0, 0, 0) by default. voxel_size: world units, one number
or three; or transform: (4, 4), world = transform @ (x, y, z, 1). Values that differ from background
by no more than tolerance, 0 or more, are not kept. C-ordered float32 is read where it lies. Raises
UsageError for arrays of other shapes or types, and for nan.)")
        .def("to_array", &toArray<Grid>, py::arg("bounds") = py::none(),
             R"(The values of a box as a dense array, and the index of its first voxel.

bounds: the first voxel and the last, by default those around what is active. Returns (an array,
float32 or of a mask bool, indexed [x, y, z]; (x, y, z)). Raises OutOfMemoryError for boxes of more than 2**34 voxels.)")
        .def(
            "blocks",
            [](const Object& self) {
                return Blocks<Grid>{self.grid, self.grid->tree().cbeginLeaf()};
            },
            "Iterates over the 8 x 8 x 8 blocks that are stored, as ((x, y, z) of the first voxel, "
            "array); arrays are read-only, and views of numbers, not copied.")
        .def_property_readonly(
            "grid_class",
            [](const Object& self) {
                return openvdb::GridBase::gridClassToString(self.grid->getGridClass());
            },
            "'fog volume', 'level set', 'staggered' or 'unknown', as OpenVDB has it.")
        .def_property(
            "name", [](const Object& self) { return textOf(self.grid->getName()); },
            [](const Object& self, const std::string& name_) { self.grid->setName(name_); })
        .def_property_readonly(
            "transform", [](const Object& self) { return matrixOf(rowsOf(*self.grid)); },
            "(4, 4): world = transform @ (x, y, z, 1) of a voxel's index.")
        .def_property_readonly(
            "voxel_size",
            [](const Object& self) {
                const openvdb::Vec3d side = self.grid->voxelSize();
                return py::make_tuple(side[0], side[1], side[2]);
            },
            "World units along x, y and z.")
        .def_property_readonly(
            "metadata", [](const Object& self) { return metadataOf(*self.grid); },
            "What the grid says of itself, as a dictionary; bandvox_... is this library's.")
        .def_property_readonly(
            "bounds",
            [](const Object& self) -> py::object {
                const CoordBBox box = self.grid->evalActiveVoxelBoundingBox();
                if (box.empty()) return py::none();
                return py::make_tuple(tupleOf(box.min()), tupleOf(box.max()));
            },
            "The first and the last active voxel; None if there is none.")
        .def_property_readonly("active_voxel_count",
                               [](const Object& self) { return self.grid->activeVoxelCount(); })
        .def_property_readonly("memory_bytes",
                               [](const Object& self) { return self.grid->memUsage(); })
        .def(
            "copy",
            [](const Object& self) {
                return std::make_shared<Object>(Object{self.grid->deepCopy()});
            },
            "The same with values of its own.")
        .def(
            "write",
            [](const Object& self, const std::filesystem::path& path, bool isHalf,
               const std::string& compression, int threads, const py::object& progress) {
                const VdbWriteOptions options = vdbOptions(isHalf, compression);
                runInBackground(
                    [&](Progress& watched) { writeGridFiles(path, {self.grid}, options, watched); },
                    progress, threads);
            },
            py::arg("path"), py::kw_only(), py::arg("half") = false,
            py::arg("compression") = "blosc", py::arg("threads") = 0,
            py::arg("progress") = py::none(),
            "Writes a .vdb file with this grid alone, as write_vdb does.")
        .def("__repr__",
             [name](const Object& self) {
                 const Coord size = self.grid->evalActiveVoxelBoundingBox().dim();
                 return textOf(std::string("<bandvox.") + name + " '" + self.grid->getName() +
                               "': " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
                               " x " + std::to_string(size[2]) + " voxels, " +
                               std::to_string(self.grid->activeVoxelCount()) + " active>");
             })
        .def(py::pickle([](const Object& self) { return bytesOf(self.grid); },
                        [](const py::bytes& bytes) {
                            auto grid = openvdb::gridPtrCast<Grid>(gridOfBytes(bytes));
                            if (!grid)
                                throw Error(ErrorKind::Input, "the pickle is of another grid");
                            return std::make_shared<Object>(Object{grid});
                        }));
}

}  // namespace

void bindGrids(py::module_& module) {
    bindGrid<openvdb::FloatGrid>(module, "Grid", "A sparse grid of numbers, as a VDB file has it.");
    bindGrid<openvdb::Vec3SGrid>(module, "VectorGrid",
                                 "A sparse grid of vectors or colours, as a VDB file has it.");
    bindGrid<openvdb::BoolGrid>(module, "MaskGrid",
                                "A sparse grid of truths, as of binary voxels. Functions that "
                                "take a Grid take it as 1 where it is active.");
}

}  // namespace bandvox::python

#include "scattered_arrays.h"

#include "arrays.h"
#include "errors.h"
#include "paths.h"

#include <bandvox/core/error.h>

#include <pybind11/stl/filesystem.h>

#include <cstdio>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using ContiguousDoubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

}  // namespace

ScatteredPoints scatteredOf(const py::handle& places, const py::handle& values, int dimensions) {
    const std::string shape = "numbers of shape (n, " + std::to_string(dimensions) + ")";
    const auto where = ContiguousDoubles::ensure(numericArray(places, "places", shape));
    if (where.ndim() != 2 || where.shape(1) != dimensions) {
        throw Error(ErrorKind::Usage, "places: found " + described(where) + "; expected " + shape);
    }
    const std::string count = std::to_string(where.shape(0));
    std::string expected = "numbers of shape (";
    expected += count + ",) or (" + count + ", columns)";
    const auto what = ContiguousDoubles::ensure(numericArray(values, "values", expected));
    const bool fits = (what.ndim() == 1 || (what.ndim() == 2 && what.shape(1) > 0)) &&
                      what.shape(0) == where.shape(0);
    if (!fits) {
        throw Error(ErrorKind::Usage,
                    "values: found " + described(what) + "; expected " + expected);
    }
    ScatteredPoints points;
    points.columns = what.ndim() == 1 ? 1 : static_cast<int>(what.shape(1));
    points.values.assign(what.data(), what.data() + what.size());
    std::vector<double>* const axes[] = {&points.x, &points.y, &points.z};
    const auto rows = static_cast<std::size_t>(where.shape(0));
    const auto width = static_cast<std::size_t>(dimensions);
    for (std::size_t axis = 0; axis < width; ++axis) {
        axes[axis]->resize(rows);
        for (std::size_t i = 0; i < rows; ++i) (*axes[axis])[i] = where.data()[width * i + axis];
    }
    return points;
}

ScatteredInput::ScatteredInput(const py::object& places, const py::object& values,
                               const std::vector<std::string>& columns, int dimensions)
    : mChoice{columns, dimensions == 3} {
    const bool isFile = isPath(places);
    if (isFile == !values.is_none()) {
        throw Error(ErrorKind::Usage, "expected a file alone, or places of shape (n, " +
                                          std::to_string(dimensions) + ") and their values");
    }
    if (isFile) {
        mPath = pathOf(places);
    } else {
        mPoints = scatteredOf(places, values, dimensions);
    }
}

const ScatteredPoints& ScatteredInput::points(Progress& progress) {
    if (!mPath.empty()) mPoints = readScatteredPoints(mPath, mChoice, progress);
    return mPoints;
}

void judgeResidual(const FitResidual& residual) {
    const std::optional<FitFault> fault = faultOf(residual);
    if (!fault) return;
    const std::string message = fault->message + ", by tolerance";
    if (fault->isError) throw Error(ErrorKind::Result, message);
    warn({message});
}

PlanePlaces planePlacesOf(const py::handle& x, const py::handle& y) {
    const std::string expected = "numbers of any shape";
    const py::sequence both = py::module_::import("numpy").attr("broadcast_arrays")(
        numericArray(x, "x", expected), numericArray(y, "y", expected));
    const auto xs = ContiguousDoubles::ensure(both[0]), ys = ContiguousDoubles::ensure(both[1]);
    return {{xs.data(), xs.data() + xs.size()},
            {ys.data(), ys.data() + ys.size()},
            {xs.shape(), xs.shape() + xs.ndim()}};
}

py::object shaped(std::vector<double> numbers, std::vector<py::ssize_t> shape) {
    const bool isNumber = shape.empty();
    py::array array = ownedArray(std::move(numbers), std::move(shape));
    if (isNumber) return array.attr("__getitem__")(py::tuple());
    return array;
}

std::string inDigits(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", number);
    return text;
}

}  // namespace bandvox::python

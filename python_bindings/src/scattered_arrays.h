#pragma once

#include <bandvox/scatter/scattered_points.h>

#include <pybind11/numpy.h>

#include <string>
#include <vector>

namespace bandvox::python {

/// Values at places, of arrays (n, 2) or (n, 3), by `dimensions`, and (n,) or (n, columns). Throws
/// Error(ErrorKind::Usage) for arrays of other shapes.
ScatteredPoints scatteredOf(const pybind11::handle& places, const pybind11::handle& values,
                            int dimensions);

/// Two arrays of numbers as NumPy makes one shape of them.
struct PlanePlaces {
    std::vector<double> x, y;
    std::vector<pybind11::ssize_t> shape;
};

/// Throws Error(ErrorKind::Usage) for what is no numbers, and NumPy's error for shapes that do not
/// go together.
PlanePlaces planePlacesOf(const pybind11::handle& x, const pybind11::handle& y);

/// An array of a shape that may be (); a number then.
pybind11::object shaped(std::vector<double> numbers, std::vector<pybind11::ssize_t> shape);

/// A number in three digits, for a message.
std::string inDigits(double number);

}  // namespace bandvox::python

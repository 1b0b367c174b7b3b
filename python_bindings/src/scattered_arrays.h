#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/fit_residual.h>
#include <bandvox/scatter/read_scattered_points.h>
#include <bandvox/scatter/scattered_points.h>

#include <pybind11/numpy.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::python {

/// Values at places, of arrays (n, 2) or (n, 3), by `dimensions`, and (n,) or (n, columns). Throws
/// Error(ErrorKind::Usage) for arrays of other shapes.
ScatteredPoints scatteredOf(const pybind11::handle& places, const pybind11::handle& values,
                            int dimensions);

/// The points of a file, or those of arrays.
class ScatteredInput {
  public:
    /// Takes the arrays now. `places`: a path, and no values then. Throws Error(ErrorKind::Usage).
    ScatteredInput(const pybind11::object& places, const pybind11::object& values,
                   const std::vector<std::string>& columns, int dimensions);

    /// Empty for arrays.
    std::string fileName() const { return mPath.filename().string(); }

    /// Reads the file if there is one, which needs no interpreter. Throws as readScatteredPoints.
    const ScatteredPoints& points(Progress& progress);

  private:
    std::filesystem::path mPath;  // empty for arrays
    PointColumnChoice mChoice;
    ScatteredPoints mPoints;
};

/// Raises or warns if a fit leaves more at the points than it should.
void judgeResidual(const FitResidual& residual);

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

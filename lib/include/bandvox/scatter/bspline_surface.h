#pragma once

#include <bandvox/core/progress.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

/// A rectangle of the plane, world units; x0 < x1 and y0 < y1.
struct Rectangle {
    double x0 = 0, y0 = 0;
    double x1 = 1, y1 = 1;

    double width() const { return x1 - x0; }
    double height() const { return y1 - y0; }
};

/// A value of a surface and its derivatives, world units.
struct SurfaceJet {
    double value = 0;
    double dx = 0, dy = 0;
    double dxx = 0, dxy = 0, dyy = 0;

    /// The upward normal of the height field, of length 1.
    std::array<double, 3> normal() const;
    double gaussianCurvature() const;
    double meanCurvature() const;  ///< positive where the height field is hollow from above
};

/// A grid of samples over a surface's rectangle, from border to border.
struct GridSampling {
    int nx = 2, ny = 2;  ///< samples along x and y, 2 or more
    int column = 0;      ///< which of the values
    int dx = 0, dy = 0;  ///< order of the derivative along x and y, 0 to 3
};

/// Values over a rectangle as a tensor product of uniform cubic B-splines; twice continuously
/// differentiable. M. Hashimoto, "Smooth Interpolation using Multiresolution Analysis".
///
/// `cells` squares of the knots along x and y, so cells + 3 control points along each axis, and as
/// many columns of values as wanted. Immutable by many threads at once.
class BsplineSurface {
  public:
    BsplineSurface() = default;

    /// `control`: [column][x][y], (cells[0] + 3) * (cells[1] + 3) for each column. Throws
    /// Error(ErrorKind::Usage) if that is not so, or the rectangle has no area.
    BsplineSurface(const Rectangle& rectangle, std::array<int, 2> cells, int columns,
                   std::vector<double> control);

    /// All control points 0.
    BsplineSurface(const Rectangle& rectangle, std::array<int, 2> cells, int columns);

    const Rectangle& rectangle() const { return mRectangle; }
    std::array<int, 2> cells() const { return mCells; }
    int columns() const { return mColumns; }

    /// Control points of a column, [x][y].
    std::span<const double> control(int column) const;
    std::span<double> control(int column);

    /// The value at a point, world units. Beyond the rectangle the outermost cubics go on.
    double value(double x, double y, int column = 0) const;

    /// The same with derivatives.
    SurfaceJet jet(double x, double y, int column = 0) const;

    /// Samples on a grid, [x][y]. Throws Error(ErrorKind::Usage) if it is none.
    std::vector<double> sample(const GridSampling& grid,
                               const Progress& progress = silentProgress()) const;

    /// The same surface with cells half as wide along the axes that are asked for: exact but for
    /// rounding.
    BsplineSurface refined(bool alongX = true, bool alongY = true) const;

    /// The same surface with so many cells, each count a power of two times what it is now.
    BsplineSurface refinedTo(std::array<int, 2> cells) const;

    /// The cells from `first` on, `cells` of them, of the surface; the rectangle shrinks with them.
    BsplineSurface cropped(std::array<int, 2> first, std::array<int, 2> cells) const;

    /// Adds a surface over the same rectangle, whose cells are as many or, by powers of two, fewer.
    void add(const BsplineSurface& coarser);

    /// The 4 x 4 Bézier ordinates of a cell, [x][y]: with equally spaced places along x and y, a
    /// bicubic patch that is the surface exactly.
    std::array<double, 16> bezierOrdinates(int cellX, int cellY, int column = 0) const;

  private:
    Rectangle mRectangle;
    std::array<int, 2> mCells{1, 1};
    int mColumns = 0;
    std::vector<double> mControl;
};

}  // namespace bandvox

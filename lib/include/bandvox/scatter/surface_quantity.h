#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/bspline_surface.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// What can be known of a surface at a place.
enum class SurfaceQuantity {
    Value,              ///< "value"
    Dx,                 ///< "dx": the derivative by x
    Dy,                 ///< "dy"
    Dxx,                ///< "dxx"
    Dxy,                ///< "dxy"
    Dyy,                ///< "dyy"
    Normal,             ///< "normal": three numbers, SurfaceJet::normal
    GaussianCurvature,  ///< "gaussian"
    MeanCurvature       ///< "mean": positive where the height field is hollow from above
};

/// All of them, in the order above.
const std::vector<SurfaceQuantity>& surfaceQuantities();

/// The word above.
std::string nameOf(SurfaceQuantity quantity);

/// The quantity of that name; nothing if there is none.
std::optional<SurfaceQuantity> surfaceQuantityNamed(std::string_view name);

/// 3 for a normal, 1 for all others.
int numbersOf(SurfaceQuantity quantity);

/// A quantity of a column on a grid of samples from border to border, world units: for each of its
/// numbers [x][y]. Throws Error(ErrorKind::Usage) if it is no grid, or there is no such column.
std::vector<std::vector<double>> sampleQuantity(const BsplineSurface& surface,
                                                std::array<int, 2> samples, int column,
                                                SurfaceQuantity quantity,
                                                const Progress& progress = silentProgress());

}  // namespace bandvox

#pragma once

#include <bandvox/source/bezier_patch.h>

#include <array>
#include <vector>

namespace bandvox {

/// A tensor-product B-spline surface, rational or not, over any knots.
struct BsplineNet {
    std::array<int, 2> degree{3, 3};  ///< along u and v, 1 to BezierPatch::kHighestDegree
    std::array<int, 2> count{0, 0};   ///< of control points along u and v, above the degree
    /// count + degree + 1 along u and v, not descending.
    std::array<std::vector<double>, 2> knots;
    /// (w x, w y, w z, w), [u][v], world units; w > 0.
    std::vector<std::array<double, 4>> control;
    /// The part of the knots' range that counts, along u and v, cut to where the splines make up
    /// a surface; all of that if the first number is not below the second.
    std::array<std::array<double, 2>, 2> range{};
};

/// The Bézier patches of a B-spline surface, one for each rectangle of its knots, which are the
/// surface exactly, but for rounding (L. Ramshaw, "Blossoming: a connect-the-dots approach to
/// splines", 1987). Up to `degree` knots nearer to each other than 1e-9 of the range of parameters
/// are one knot, of their number's multiplicity, if the surface moves by less than 1e-6 of its
/// control polygon between them. Where more than `degree` knots are near but not equal, it moves
/// a whole stretch, and what is between them are patches; where more than `degree` are equal, but
/// for the rounding of doubles, it is cut in two, and nothing bridges the gap. What `range` leaves
/// between two knots is left out if it is narrower than 1e-9 of all parameters, or of what is
/// between the two if that is narrower itself. Throws Error(ErrorKind::Usage) if counts or knots
/// are not as above.
std::vector<BezierPatch> bezierPatches(const BsplineNet& net);

}  // namespace bandvox

#pragma once

#include "outline/drawing/view_matrix.h"
#include "outline/patches/bernstein.h"

#include <bandvox/source/bezier_patch.h>

#include <array>
#include <vector>

namespace bandvox {

/// A point of a patch on the page: X, Y in page units, Z, and derivatives by u and v.
struct ViewPoint {
    double x = 0, y = 0, z = 0;
    double xu = 0, yu = 0, zu = 0;
    double xv = 0, yv = 0, zv = 0;
};

/// A patch as the view sees it.
///
/// Its contour is where the map (u, v) -> (X, Y) folds: F = det(P, P_u, P_v) = 0 with P = (wX, wY,
/// w), a polynomial, which is (S - V) . N = 0 of equation (1) of the paper, times a positive
/// factor. "Vector rendering of free-form surfaces".
struct ViewPatch {
    Bernstein2 x, y, z, w;  ///< w is of degree 0 if the patch is not rational on the page
    Bernstein2 f;           ///< without the factors that vanish along collapsed sides
    bool hasFold = true;    ///< false if F vanishes everywhere: the patch is a curve, or a point
    std::array<bool, 4> collapsed{};  ///< sides that are points: u = 0, u = 1, v = 0, v = 1
    int object = 0;

    ViewPoint at(double u, double v) const;
};

/// `size`: of the page, to tell lengths that are as good as 0.
ViewPatch seenBy(const ViewMatrix& view, const BezierPatch& patch, double size);

/// The same of many.
std::vector<ViewPatch> seenBy(const ViewMatrix& view, const std::vector<BezierPatch>& patches,
                              double size);

/// The point of a side at t, 0 to 1: the parameter along it.
std::array<double, 2> onSide(int side, double t);

/// The direction of the fold's image, of length 1 without a sign: where F = 0 the derivatives by u
/// and v are parallel on the page.
std::array<double, 2> foldDirection(const ViewPoint& point);

}  // namespace bandvox

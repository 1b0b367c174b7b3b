#include "nurbs_surface.h"

#include <bandvox/core/error.h>
#include <bandvox/source/bezier_patch.h>

#include <GeomConvert.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <string>

namespace bandvox {
namespace {

Handle(Geom_Surface) basisOf(Handle(Geom_Surface) surface) {
    while (true) {
        const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
        if (trimmed.IsNull()) return surface;
        surface = trimmed->BasisSurface();
    }
}

// Conversions to B-splines keep these ones' parameters.
bool isFreeForm(const Handle(Geom_Surface) & surface) {
    return !Handle(Geom_Plane)::DownCast(surface).IsNull() ||
           !Handle(Geom_BezierSurface)::DownCast(surface).IsNull() ||
           !Handle(Geom_BSplineSurface)::DownCast(surface).IsNull() ||
           !Handle(Geom_OffsetSurface)::DownCast(surface).IsNull();
}

// Borders may be beyond a surface's ends, or more than once around, by rounding: conversions refuse
// that.
void keepWithin(const Handle(Geom_Surface) & surface, ParameterBox& box) {
    ParameterBox all;
    surface->Bounds(all.low[0], all.high[0], all.low[1], all.high[1]);
    for (std::size_t c = 0; c < 2; ++c) {
        const bool isU = c == 0;
        if (isU ? surface->IsUPeriodic() : surface->IsVPeriodic()) {
            const double period = isU ? surface->UPeriod() : surface->VPeriod();
            const double size = box.high[c] - box.low[c];
            if (size > (1 + 1e-9) * period) {
                throw Error(ErrorKind::Input,
                            "has a face that goes around its surface more than "
                            "once; expected such faces to be cut in two");
            }
            if (size > (1 - 1e-9) * period) box.high[c] = box.low[c] + period;
            // Once around from where it begins needs no more knots.
            const double turns = (box.low[c] - all.low[c]) / period;
            const double shift = std::round(turns) * period;
            const bool isWhole = box.high[c] == box.low[c] + period;
            if (isWhole && std::abs(turns - std::round(turns)) < 1e-9) {
                box.low[c] = all.low[c] + shift;
                box.high[c] = box.low[c] + period;
            }
        } else {
            const double near = 1e-9 * (all.high[c] - all.low[c]);
            if (box.low[c] < all.low[c] + near) box.low[c] = all.low[c];
            if (box.high[c] > all.high[c] - near) box.high[c] = all.high[c];
        }
    }
}

// Whether the box is all of the surface, which then is taken as it is.
bool isAll(const Handle(Geom_BSplineSurface) & spline, const ParameterBox& box) {
    if (spline->IsUPeriodic() || spline->IsVPeriodic()) return false;
    ParameterBox all;
    spline->Bounds(all.low[0], all.high[0], all.low[1], all.high[1]);
    return box.low == all.low && box.high == all.high;
}

void requireDegree(int degree) {
    if (degree <= BezierPatch::kHighestDegree) return;
    throw Error(ErrorKind::Input, "has a surface of degree " + std::to_string(degree) +
                                      "; expected at most " +
                                      std::to_string(BezierPatch::kHighestDegree));
}

}  // namespace

NurbsSurface::NurbsSurface(const Handle(Geom_Surface) & surface, const ParameterBox& box)
    : mSurface(basisOf(surface)), mBox(box) {
    keepWithin(mSurface, mBox);
    const auto spline = Handle(Geom_BSplineSurface)::DownCast(mSurface);
    if (!spline.IsNull() && isAll(spline, mBox)) {
        mSpline = spline;
    } else {
        const Handle(Geom_Surface) part = new Geom_RectangularTrimmedSurface(
            mSurface, mBox.low[0], mBox.high[0], mBox.low[1], mBox.high[1]);
        mSpline = GeomConvert::SurfaceToBSplineSurface(part);
        if (mSpline->IsUPeriodic()) mSpline->SetUNotPeriodic();
        if (mSpline->IsVPeriodic()) mSpline->SetVNotPeriodic();
    }
    mSpline->Bounds(mRange[0][0], mRange[0][1], mRange[1][0], mRange[1][1]);
    fillNet();
    mKeeps = isFreeForm(mSurface);
    if (mKeeps) return;
    // Along a line on which the surface goes on as fast as anywhere, a coordinate is told best.
    for (std::size_t c = 0; c < 2; ++c) mReference[c] = 0.5 * (mBox.low[c] + mBox.high[c]);
    double fastest = -1;
    const double middle = mReference[0];
    for (const double share : {0.5, 0.3, 0.7, 0.1, 0.9}) {
        const double v = mBox.low[1] + share * (mBox.high[1] - mBox.low[1]);
        gp_Pnt point;
        gp_Vec du, dv;
        mSurface->D1(middle, v, point, du, dv);
        if (du.Magnitude() <= fastest * 1.5) continue;
        fastest = du.Magnitude();
        mReference[1] = v;
    }
    for (std::size_t c = 0; c < 2; ++c) {
        const double share = (mReference[c] - mBox.low[c]) / (mBox.high[c] - mBox.low[c]);
        mSplineReference[c] = mRange[c][0] + share * (mRange[c][1] - mRange[c][0]);
    }
    mSplineReference = locate(mReference, mSplineReference);
}

void NurbsSurface::fillNet() {
    mNet.degree = {mSpline->UDegree(), mSpline->VDegree()};
    for (const int degree : mNet.degree) requireDegree(degree);
    mNet.count = {mSpline->NbUPoles(), mSpline->NbVPoles()};
    for (int i = 1; i <= mNet.count[0]; ++i) {
        for (int j = 1; j <= mNet.count[1]; ++j) {
            const gp_Pnt p = mSpline->Pole(i, j);
            const double w = mSpline->Weight(i, j);
            if (!(w > 0)) {
                throw Error(ErrorKind::Input, "has a control point of weight " + std::to_string(w) +
                                                  "; expected weights above 0");
            }
            mNet.control.push_back({w * p.X(), w * p.Y(), w * p.Z(), w});
        }
    }
    for (int k = 1; k <= mSpline->NbUKnots(); ++k) {
        mNet.knots[0].insert(mNet.knots[0].end(),
                             static_cast<std::size_t>(mSpline->UMultiplicity(k)),
                             mSpline->UKnot(k));
    }
    for (int k = 1; k <= mSpline->NbVKnots(); ++k) {
        mNet.knots[1].insert(mNet.knots[1].end(),
                             static_cast<std::size_t>(mSpline->VMultiplicity(k)),
                             mSpline->VKnot(k));
    }
}

std::array<double, 2> NurbsSurface::locate(const std::array<double, 2>& p,
                                           std::array<double, 2> guess) const {
    const gp_Pnt wanted = mSurface->Value(p[0], p[1]);
    for (int step = 0; step < 30; ++step) {
        gp_Pnt found;
        gp_Vec du, dv;
        mSpline->D1(guess[0], guess[1], found, du, dv);
        const gp_Vec gap(found, wanted);
        const double uu = du.Dot(du), uv = du.Dot(dv), vv = dv.Dot(dv);
        const double area = uu * vv - uv * uv;
        if (!(area > 0)) break;
        const double gu = gap.Dot(du), gv = gap.Dot(dv);
        const double moveU = (gu * vv - gv * uv) / area, moveV = (gv * uu - gu * uv) / area;
        const std::array<double, 2> before = guess;
        guess[0] = std::clamp(guess[0] + moveU, mRange[0][0], mRange[0][1]);
        guess[1] = std::clamp(guess[1] + moveV, mRange[1][0], mRange[1][1]);
        const double size = mRange[0][1] - mRange[0][0] + mRange[1][1] - mRange[1][0];
        if (std::abs(guess[0] - before[0]) + std::abs(guess[1] - before[1]) < 1e-15 * size) break;
    }
    return guess;
}

std::array<double, 2> NurbsSurface::placeOf(const std::array<double, 2>& p) const {
    std::array<double, 2> place = p;
    for (std::size_t c = 0; c < 2; ++c) {
        const double inside = std::clamp(p[c], mBox.low[c], mBox.high[c]);
        const bool isEnd = inside == mBox.low[c] || inside == mBox.high[c];
        if (!mKeeps && !isEnd) {
            std::array<double, 2> from = mReference, guess = mSplineReference;
            from[c] = inside;
            const double share = (inside - mBox.low[c]) / (mBox.high[c] - mBox.low[c]);
            guess[c] = mRange[c][0] + share * (mRange[c][1] - mRange[c][0]);
            place[c] = locate(from, guess)[c];
        }
        // What is beyond the range goes on evenly: by rounding.
        const double low = mKeeps || isEnd ? mBox.low[c] : mRange[c][0];
        const double high = mKeeps || isEnd ? mBox.high[c] : mRange[c][1];
        place[c] = (place[c] - low) / (high - low);
    }
    return place;
}

std::vector<double> NurbsSurface::breaks(std::size_t axis) const {
    // At knots conversions keep the parameters of all surfaces.
    std::vector<double> result;
    const bool isU = axis == 0;
    const int count = isU ? mSpline->NbUKnots() : mSpline->NbVKnots();
    const double scale = (mBox.high[axis] - mBox.low[axis]) / (mRange[axis][1] - mRange[axis][0]);
    for (int k = 2; k < count; ++k) {
        const double knot = isU ? mSpline->UKnot(k) : mSpline->VKnot(k);
        result.push_back(mBox.low[axis] + scale * (knot - mRange[axis][0]));
    }
    return result;
}

}  // namespace bandvox

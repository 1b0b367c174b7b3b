#include "source/face_trim.h"

#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <cstddef>

namespace bandvox {
namespace {

constexpr int kLines = 7, kAlong = 4;  // numbers of intervalRule: their points less 1

ParameterBox boxOf(const ParameterCell& cell) {
    return {{cell.u0, cell.v0}, {cell.u1, cell.v1}};
}

}  // namespace

CellTrim::Share FaceTrim::share(const Patch&, const ParameterCell& cell) const {
    if (mRegions.mayCut(mPatch, boxOf(cell))) return Share::Unknown;
    const bool isKept =
        mRegions.keeps(mPatch, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1));
    return isKept ? Share::All : Share::None;
}

std::vector<TrimmedPoint> FaceTrim::rule(const Patch&, const ParameterCell& cell) const {
    // In the face's parameters, those of the loops.
    const auto range = placeOf(&mRegions, mPatch).range;
    const std::array<double, 2> size{range[0][1] - range[0][0], range[1][1] - range[1][0]};
    const double u0 = range[0][0] + cell.u0 * size[0], u1 = range[0][0] + cell.u1 * size[0];
    const double v0 = range[1][0] + cell.v0 * size[1], v1 = range[1][0] + cell.v1 * size[1];

    // Where lines along u begin to meet other parts of loops.
    std::vector<const FaceRegions::Part*> parts;
    std::vector<double> ends{v0, v1};
    mRegions.visitParts(mPatch, boxOf(cell), [&](const FaceRegions::Part& part) {
        parts.push_back(&part);
        ends.push_back(part.curve.front()[1]);
        ends.push_back(part.curve.back()[1]);
        for (const double u : {u0, u1}) {
            for (const double t : crossingsOf(part.curve, 0, u)) {
                ends.push_back(jetAt(part.curve, t).place[1]);
            }
        }
    });
    std::erase_if(ends, [&](double v) { return !(v >= v0 && v <= v1); });
    std::sort(ends.begin(), ends.end());

    std::vector<TrimmedPoint> points;
    std::vector<double> cuts;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double height = ends[k + 1] - ends[k];
        if (!(height > 0)) continue;
        for (const IntervalPoint& line : intervalRule(kLines)) {
            // v = s²(3 - 2s) makes square roots at both ends smooth functions of s.
            const double s = line.position;
            const double v = ends[k] + height * s * s * (3 - 2 * s);
            const double weight = line.weight * height * 6 * s * (1 - s);
            cuts.assign({u0});
            for (const FaceRegions::Part* part : parts) {
                if (v < part->box.low[1] || v >= part->box.high[1]) continue;
                const double u = jetAt(part->curve, part->shareAt(v)).place[0];
                if (u > u0 && u < u1) cuts.push_back(u);
            }
            cuts.push_back(u1);
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
                const double length = cuts[i + 1] - cuts[i];
                const auto local = [&](double x, std::size_t c) {
                    return (x - range[c][0]) / size[c];
                };
                const double y = local(v, 1);
                if (!mRegions.keeps(mPatch, local(cuts[i] + 0.5 * length, 0), y)) continue;
                for (const IntervalPoint& p : intervalRule(kAlong)) {
                    points.push_back({local(cuts[i] + p.position * length, 0), y,
                                      weight * p.weight * length / (size[0] * size[1])});
                }
            }
        }
    }
    return points;
}

}  // namespace bandvox

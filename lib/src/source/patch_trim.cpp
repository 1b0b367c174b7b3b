#include "source/patch_trim.h"

#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <array>

namespace bandvox {
namespace {

using openvdb::Vec3d;

constexpr std::size_t kProbes = 5;  ///< along a line of a cell
constexpr int kHalvings = 24;       ///< towards where a line is cut
constexpr int kCutRule = 4;         ///< number of intervalRule: its points less 1

/// A cell, with its parameters from 0 to 1, exchanged if the cut runs along v.
struct CellFrame {
    const PatchTrim& trim;
    const Patch& patch;
    ParameterCell cell;
    bool exchanged = false;

    TrimmedPoint at(double across, double along, double weight) const {
        const double du = cell.u1 - cell.u0;
        const double dv = cell.v1 - cell.v0;
        const double u = cell.u0 + du * (exchanged ? along : across);
        const double v = cell.v0 + dv * (exchanged ? across : along);
        return {u, v, weight * du * dv};
    }
    bool keeps(double across, double along) const {
        const TrimmedPoint p = at(across, along, 0);
        return trim.keeps(patch, p.u, p.v);
    }
};

/// Where what is left of a line begins and ends, from 0 to 1.
struct LineCuts {
    std::vector<double> places;
    bool startsKept = false;
};

template <typename Keeps>
LineCuts cutsOf(const Keeps& keeps) {
    LineCuts cuts;
    std::array<bool, kProbes> kept{};
    for (std::size_t k = 0; k < kProbes; ++k) {
        kept[k] = keeps(static_cast<double>(k) / (kProbes - 1));
    }
    cuts.startsKept = kept[0];
    for (std::size_t k = 0; k + 1 < kProbes; ++k) {
        if (kept[k] == kept[k + 1]) continue;
        double low = static_cast<double>(k) / (kProbes - 1);
        double high = static_cast<double>(k + 1) / (kProbes - 1);
        for (int step = 0; step < kHalvings; ++step) {
            const double middle = 0.5 * (low + high);
            (keeps(middle) == kept[k] ? low : high) = middle;
        }
        cuts.places.push_back(0.5 * (low + high));
    }
    return cuts;
}

void addLine(const CellFrame& frame, double across, double weight,
             std::vector<TrimmedPoint>& points) {
    LineCuts cuts = cutsOf([&](double along) { return frame.keeps(across, along); });
    cuts.places.insert(cuts.places.begin(), 0);
    cuts.places.push_back(1);
    bool isKept = cuts.startsKept;
    for (std::size_t k = 0; k + 1 < cuts.places.size(); ++k, isKept = !isKept) {
        if (!isKept) continue;
        const double from = cuts.places[k];
        const double length = cuts.places[k + 1] - from;
        for (const IntervalPoint& p : intervalRule(kCutRule)) {
            points.push_back(
                frame.at(across, from + p.position * length, weight * p.weight * length));
        }
    }
}

}  // namespace

PatchTrim::Share PatchTrim::share(const Patch& patch, const ParameterCell& cell) const {
    const openvdb::BBoxd box = patch.bounds(cell);
    for (std::size_t k = 0; k < mPieces.size(); ++k) {
        if (k != mOwn && mPieces[k].winding->mayMeet(box)) return Share::Unknown;
    }
    return keeps(patch, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)) ? Share::All
                                                                              : Share::None;
}

std::vector<TrimmedPoint> PatchTrim::rule(const Patch& patch, const ParameterCell& cell) const {
    return trimmedRule(*this, patch, cell);
}

bool PatchTrim::keeps(const Patch& patch, double u, double v) const {
    const PatchPoint p = patch.at(u, v);
    Vec3d normal = p.du.cross(p.dv);
    if (!normal.normalize(0)) normal = Vec3d(0);
    int before = mPieces[mOwn].isCavity ? -1 : 0;
    int behind = before + 1;
    for (std::size_t k = 0; k < mPieces.size(); ++k) {
        if (k == mOwn) continue;
        const PatchWinding& other = *mPieces[k].winding;
        const int outside = other.at(p.position + mDistance * normal);
        const int inside = other.at(p.position - mDistance * normal);
        if (inside > outside && k < mOwn) return false;  // is counted there
        before += outside;
        behind += inside;
    }
    return before <= 0 && behind >= 1;
}

std::vector<TrimmedPoint> trimmedRule(const PatchTrim& trim, const Patch& patch,
                                      const ParameterCell& cell) {
    // See which way the cut runs.
    CellFrame frame{trim, patch, cell};
    std::array<std::array<bool, kProbes>, kProbes> kept{};
    for (std::size_t i = 0; i < kProbes; ++i) {
        for (std::size_t j = 0; j < kProbes; ++j) {
            kept[i][j] = frame.keeps(static_cast<double>(i) / (kProbes - 1),
                                     static_cast<double>(j) / (kProbes - 1));
        }
    }
    int alongU = 0, alongV = 0;
    for (std::size_t i = 0; i < kProbes; ++i) {
        for (std::size_t j = 0; j + 1 < kProbes; ++j) {
            alongV += kept[i][j] != kept[i][j + 1] ? 1 : 0;
            alongU += kept[j][i] != kept[j + 1][i] ? 1 : 0;
        }
    }
    frame.exchanged = alongU > alongV;

    // What is left of lines is smooth from line to line between those at which the cut leaves.
    std::vector<double> ends{0, 1};
    for (const double along : {0.0, 1.0}) {
        const LineCuts cuts = cutsOf([&](double across) { return frame.keeps(across, along); });
        ends.insert(ends.end(), cuts.places.begin(), cuts.places.end());
    }
    std::sort(ends.begin(), ends.end());
    std::vector<TrimmedPoint> points;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double width = ends[k + 1] - ends[k];
        if (!(width > 0)) continue;
        for (const IntervalPoint& p : intervalRule(kCutRule)) {
            addLine(frame, ends[k] + p.position * width, p.weight * width, points);
        }
    }
    return points;
}

}  // namespace bandvox

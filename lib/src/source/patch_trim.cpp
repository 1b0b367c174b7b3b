#include "source/patch_trim.h"

#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <array>

namespace bandvox {

/// One cell of a patch in a union. Pieces that are not near it wind as often around all of it, and
/// are asked once.
class PieceCell {
  public:
    PieceCell(const PatchTrim& trim, const Patch& patch, const ParameterCell& cell);

    const ParameterCell& cell() const { return mCell; }

    /// True if no other piece is near: all points of the cell are left, or none.
    bool isUniform() const { return mNear.empty(); }

    /// True if the point of the cell is left.
    bool keeps(double u, double v) const;

  private:
    openvdb::Vec3d normalAt(const PatchPoint& p, double u, double v) const;

    const PatchTrim& mTrim;
    const Patch& mPatch;
    ParameterCell mCell;
    int mAround;  // how often its own piece, seen from before it, and those that are not near wind
    std::vector<std::size_t> mNear;
};

namespace {

using openvdb::Vec3d;

constexpr std::size_t kProbes = 5;  ///< along a line of a cell
constexpr int kHalvings = 24;       ///< towards where a line is cut
constexpr int kCutRule = 4;         ///< number of intervalRule: its points less 1

/// A cell with its parameters from 0 to 1, exchanged if the cut runs along v.
struct CellFrame {
    const PieceCell& trim;
    bool exchanged = false;

    TrimmedPoint at(double across, double along, double weight) const {
        const ParameterCell& cell = trim.cell();
        const double du = cell.u1 - cell.u0;
        const double dv = cell.v1 - cell.v0;
        const double u = cell.u0 + du * (exchanged ? along : across);
        const double v = cell.v0 + dv * (exchanged ? across : along);
        return {u, v, weight * du * dv};
    }
    bool keeps(double across, double along) const {
        const TrimmedPoint p = at(across, along, 0);
        return trim.keeps(p.u, p.v);
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

std::vector<TrimmedPoint> wholeRule(const CellFrame& frame) {
    std::vector<TrimmedPoint> points;
    for (const IntervalPoint& p : intervalRule(kCutRule)) {
        for (const IntervalPoint& q : intervalRule(kCutRule)) {
            points.push_back(frame.at(p.position, q.position, p.weight * q.weight));
        }
    }
    return points;
}

}  // namespace

PieceCell::PieceCell(const PatchTrim& trim, const Patch& patch, const ParameterCell& cell)
    : mTrim(trim), mPatch(patch), mCell(cell), mAround(trim.mPieces[trim.mOwn].isCavity ? -1 : 0) {
    openvdb::BBoxd box = patch.bounds(cell);
    box.expand(trim.mDistance);
    const Vec3d middle = patch.at(0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)).position;
    for (std::size_t k = 0; k < trim.mPieces.size(); ++k) {
        if (k == trim.mOwn) continue;
        const PatchWinding& other = *trim.mPieces[k].winding;
        if (other.mayMeet(box)) {
            mNear.push_back(k);
        } else {
            mAround += other.at(middle);
        }
    }
}

// Where a side of the patch has collapsed there is no normal but beside it.
Vec3d PieceCell::normalAt(const PatchPoint& p, double u, double v) const {
    Vec3d normal = p.du.cross(p.dv);
    const double speed =
        std::max(p.du.length() * (mCell.u1 - mCell.u0), p.dv.length() * (mCell.v1 - mCell.v0));
    constexpr double kFlat = 1e-9;
    const double area = normal.length() * (mCell.u1 - mCell.u0) * (mCell.v1 - mCell.v0);
    if (!(area > kFlat * speed * speed)) {
        constexpr double kAside = 1e-3;
        const double middleU = 0.5 * (mCell.u0 + mCell.u1), middleV = 0.5 * (mCell.v0 + mCell.v1);
        const PatchPoint near = mPatch.at(u + kAside * (middleU - u), v + kAside * (middleV - v));
        normal = near.du.cross(near.dv);
    }
    if (!normal.normalize(0)) normal = Vec3d(0);
    return normal;
}

bool PieceCell::keeps(double u, double v) const {
    int before = mAround, behind = mAround + 1;
    if (!mNear.empty()) {
        const PatchPoint p = mPatch.at(u, v);
        const Vec3d normal = normalAt(p, u, v);
        for (const std::size_t k : mNear) {
            const PatchWinding& other = *mTrim.mPieces[k].winding;
            const int outside = other.at(p.position + mTrim.mDistance * normal);
            const int inside = other.at(p.position - mTrim.mDistance * normal);
            if (inside > outside && k < mTrim.mOwn) return false;  // is counted there
            before += outside;
            behind += inside;
        }
    }
    return before <= 0 && behind >= 1;
}

PatchTrim::Share PatchTrim::share(const Patch& patch, const ParameterCell& cell) const {
    const PieceCell piece(*this, patch, cell);
    if (!piece.isUniform()) return Share::Unknown;
    return piece.keeps(cell.u0, cell.v0) ? Share::All : Share::None;
}

std::vector<TrimmedPoint> PatchTrim::rule(const Patch& patch, const ParameterCell& cell) const {
    const PieceCell trim(*this, patch, cell);
    // See which way the cut runs.
    CellFrame frame{trim};
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
    if (alongU + alongV == 0) return kept[0][0] ? wholeRule(frame) : std::vector<TrimmedPoint>();
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

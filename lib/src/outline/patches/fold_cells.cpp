#include "outline/patches/fold_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

constexpr int kDeepest = 18;
constexpr std::size_t kMostCells = 20000;
constexpr double kNear = 1e-10;  // of a rectangle's side, from which one step reaches the curve

struct FoldCell {
    double u0, v0, size;
    int depth;
    Bernstein2 f;
};

// Where F = 0 meets a rectangle's border: the lead and the follower there.
using BorderRoot = std::array<double, 2>;

enum class Sign { Positive, Negative, Mixed };

Sign signOf(const Bernstein2& p) {
    if (p.smallest() > 0) return Sign::Positive;
    if (p.largest() < 0) return Sign::Negative;
    return Sign::Mixed;
}

// The coefficients of a cell with the lead as the first variable.
std::vector<double> lineOf(const Bernstein2& f, bool leadIsU, bool alongLead, bool atEnd) {
    std::vector<double> line;
    const bool alongU = leadIsU == alongLead;
    const int count = alongU ? f.m : f.n;
    for (int k = 0; k <= count; ++k) {
        line.push_back(alongU ? f.at(k, atEnd ? f.n : 0) : f.at(atEnd ? f.m : 0, k));
    }
    return line;
}

// The stretches of a cell in which F is strictly monotone in the follower; false if what is found
// on its border does not match, because of rounding.
bool appendStretches(const FoldCell& cell, bool leadIsU, std::vector<FoldStretch>& stretches) {
    FoldStretch stretch;
    stretch.leadIsU = leadIsU;
    const double lead0 = leadIsU ? cell.u0 : cell.v0;
    stretch.follow0 = leadIsU ? cell.v0 : cell.u0;
    stretch.follow1 = stretch.follow0 + cell.size;
    std::vector<BorderRoot> ends;
    for (const bool atEnd : {false, true}) {
        std::vector<double> roots;
        const double low = stretch.follow0;
        appendRoots(lineOf(cell.f, leadIsU, false, atEnd), low, low + cell.size, roots);
        for (const double root : roots) ends.push_back({lead0 + (atEnd ? cell.size : 0), root});
        roots.clear();
        appendRoots(lineOf(cell.f, leadIsU, true, atEnd), lead0, lead0 + cell.size, roots);
        for (const double root : roots) {
            ends.push_back({root, atEnd ? stretch.follow1 : stretch.follow0});
        }
    }
    if (ends.size() % 2 != 0) return false;
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        stretch.lead0 = ends[i][0];
        stretch.lead1 = ends[i + 1][0];
        stretch.start = ends[i][1];
        stretch.end = ends[i + 1][1];
        if (stretch.lead0 < stretch.lead1) stretches.push_back(stretch);
    }
    return true;
}

}  // namespace

std::array<double, 2> FoldStretch::at(const ViewPatch& patch, double lead, double guess) const {
    const auto place = [&](double follow) {
        return leadIsU ? std::array{lead, follow} : std::array{follow, lead};
    };
    if (lead <= lead0) return place(start);
    if (lead >= lead1) return place(end);
    const auto valueAt = [&](double follow) {
        const auto [u, v] = place(follow);
        const Gradient2 g = evaluate(patch.f, u, v);
        return std::pair{g.value, leadIsU ? g.dv : g.du};
    };
    double low = follow0, high = follow1;
    double follow = std::clamp(guess, low, high);
    bool rises = true;
    for (int step = 0; step < 60; ++step) {
        const auto [value, slope] = valueAt(follow);
        if (step == 0) rises = slope > 0;
        ((value >= 0) == rises ? high : low) = follow;
        double next = follow - value / slope;
        // Each step squares the error.
        const bool isThere = std::abs(next - follow) < kNear * (follow1 - follow0);
        if (!isThere && !(next > low && next < high)) next = 0.5 * (low + high);
        follow = std::clamp(next, follow0, follow1);
        if (isThere || high - low < 1e-15) break;
    }
    return place(follow);
}

FoldCells isolateFold(const ViewPatch& patch) {
    FoldCells result;
    if (!patch.hasFold) return result;
    std::vector<FoldCell> level{{0, 0, 1, 0, patch.f}};
    std::size_t cells = 0;
    // Breadth first, so that where there are too many cells all are of the same size.
    while (!level.empty()) {
        std::vector<FoldCell> next;
        for (FoldCell& cell : level) {
            if (signOf(cell.f) != Sign::Mixed) continue;
            const bool byV = signOf(derivativeU(cell.f)) != Sign::Mixed;
            const bool byU = signOf(derivativeV(cell.f)) != Sign::Mixed;
            if (byV && appendStretches(cell, false, result.stretches)) continue;
            if (byU && appendStretches(cell, true, result.stretches)) continue;
            if (cell.depth == kDeepest || cells > kMostCells) {
                result.looseEnds = std::max(result.looseEnds, 4 * cell.size);
                continue;
            }
            const double half = 0.5 * cell.size;
            auto parts = quarters(cell.f);
            for (std::size_t q = 0; q < 4; ++q) {
                next.push_back({cell.u0 + (q >= 2 ? half : 0), cell.v0 + (q % 2 ? half : 0), half,
                                cell.depth + 1, std::move(parts[q])});
                ++cells;
            }
        }
        level = std::move(next);
    }
    return result;
}

}  // namespace bandvox

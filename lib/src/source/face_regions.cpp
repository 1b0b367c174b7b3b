#include "source/face_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {
namespace {

constexpr double kRows = 64;

// Cuts a curve where v turns back.
void appendParts(const ParameterCurve& curve, std::vector<FaceRegions::Part>& parts) {
    ParameterCurve rest = curve;
    double done = 0;
    const auto add = [&](ParameterCurve piece) {
        const ParameterBox box = boxOf(piece);
        const bool isRising = piece.back()[1] >= piece.front()[1];
        parts.push_back({std::move(piece), box, isRising});
    };
    for (const double turn : turnsOf(curve, 1)) {
        if (!(turn > done && turn < 1)) continue;
        auto [low, high] = divided(std::move(rest), (turn - done) / (1 - done));
        add(std::move(low));
        rest = std::move(high);
        done = turn;
    }
    add(std::move(rest));
}

}  // namespace

FaceRegions::FaceRegions(const FaceTopology& topology)
    : mTopology(&topology), mRegions(topology.faces.size()) {
    for (const FaceEdge& edge : topology.edges) {
        for (const EdgeUse& use : edge.uses) {
            for (const EdgePiece& piece : use.pieces) {
                mPieces.push_back(&piece);
                mEdges.push_back(&edge);
            }
        }
    }
    for (std::size_t f = 0; f < mRegions.size(); ++f) {
        Region& region = mRegions[f];
        for (const ParameterCurve& curve : topology.faces[f].loops) {
            appendParts(curve, region.parts);
        }
        if (region.parts.empty()) continue;
        region.rows.resize(static_cast<std::size_t>(kRows));
        for (std::size_t k = 0; k < region.parts.size(); ++k) {
            const ParameterBox& box = region.parts[k].box;
            for (std::size_t r = rowOf(box.low[1]); r <= rowOf(box.high[1]); ++r) {
                region.rows[r].push_back(static_cast<std::uint32_t>(k));
            }
        }
    }
}

std::size_t FaceRegions::rowOf(double v) {
    if (!(v > 0)) return 0;  // NaN, too
    return static_cast<std::size_t>(std::min(v * kRows, kRows - 1));
}

const FaceRegions::Region* FaceRegions::regionOf(int patch) const {
    if (!mTopology || mTopology->places.empty()) return nullptr;
    const int face = mTopology->places[static_cast<std::size_t>(patch)].face;
    if (face < 0) return nullptr;
    const Region& region = mRegions[static_cast<std::size_t>(face)];
    return region.parts.empty() ? nullptr : &region;
}

bool FaceRegions::Part::meets(const ParameterBox& other) const {
    if (!box.meets(other)) return false;
    if (curve.size() == 2 && box.low[1] == box.high[1]) return true;
    // Only what has such a v may be there.
    double from = other.low[1] <= box.low[1] ? 0 : shareAt(other.low[1]);
    double to = other.high[1] >= box.high[1] ? 1 : shareAt(other.high[1]);
    if (!isRising) {
        from = other.high[1] >= box.high[1] ? 0 : shareAt(other.high[1]);
        to = other.low[1] <= box.low[1] ? 1 : shareAt(other.low[1]);
    }
    return boxOf(partOf(curve, from, std::max(from, to))).meets(other);
}

double FaceRegions::Part::shareAt(double v) const {
    const double rise = curve.back()[1] - curve.front()[1];
    if (curve.size() == 2) {
        return rise != 0 ? std::clamp((v - curve.front()[1]) / rise, 0.0, 1.0) : 0.5;
    }
    // Newton's method within a bracket, until only rounding is left.
    const double rounding = 2 * std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(curve.front()[1]), std::abs(curve.back()[1]));
    double low = 0, high = 1;
    double t = rise != 0 ? std::clamp((v - curve.front()[1]) / rise, 0.0, 1.0) : 0.5;
    for (int step = 0; step < 60; ++step) {
        const ParameterJet jet = jetAt(curve, t);
        const double off = jet.place[1] - v;
        if (std::abs(off) <= rounding) break;
        ((off < 0) == isRising ? low : high) = t;
        double next = jet.slope[1] != 0 ? t - off / jet.slope[1] : low - 1;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - t) < 1e-15) break;
        t = next;
    }
    return t;
}

bool FaceRegions::keeps(int patch, double u, double v) const {
    const Region* region = regionOf(patch);
    if (!region) return true;
    const auto& range = mTopology->places[static_cast<std::size_t>(patch)].range;
    const double x = range[0][0] + u * (range[0][1] - range[0][0]);
    const double y = range[1][0] + v * (range[1][1] - range[1][0]);
    bool isInside = false;
    for (const std::uint32_t k : region->rows[rowOf(y)]) {
        const Part& part = region->parts[k];
        // Ends count to the part above them, so that each line meets a loop an even number of
        // times.
        const double a = part.curve.front()[1], b = part.curve.back()[1];
        if (!(std::min(a, b) <= y && y < std::max(a, b)) || part.box.high[0] <= x) continue;
        const bool isRight = part.box.low[0] > x || jetAt(part.curve, part.shareAt(y)).place[0] > x;
        if (isRight) isInside = !isInside;
    }
    return isInside;
}

ParameterBox FaceRegions::inFace(int patch, const ParameterBox& box) const {
    const auto& range = mTopology->places[static_cast<std::size_t>(patch)].range;
    ParameterBox result;
    for (const auto& corner : {box.low, box.high}) {
        std::array<double, 2> p{};
        for (std::size_t c = 0; c < 2; ++c) {
            p[c] = range[c][0] + corner[c] * (range[c][1] - range[c][0]);
        }
        result.expand(p);
    }
    return result;
}

bool FaceRegions::mayCut(int patch, const ParameterBox& box) const {
    const Region* region = regionOf(patch);
    if (!region) return false;
    const ParameterBox inside = inFace(patch, box);
    for (std::size_t r = rowOf(inside.low[1]); r <= rowOf(inside.high[1]); ++r) {
        for (const std::uint32_t k : region->rows[r]) {
            if (region->parts[k].meets(inside)) return true;
        }
    }
    return false;
}

}  // namespace bandvox

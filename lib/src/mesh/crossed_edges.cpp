#include "mesh/crossed_edges.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

constexpr int kMostSteps = 60;

// A place counts as on the surface at this part of the tolerance: distance is estimated.
constexpr double kSafety = 0.25;

bool isOnSurface(const DensityAt& at, double iso, double tolerance) {
    return std::abs(at.value - iso) <= kSafety * tolerance * at.gradient.length();
}

}  // namespace

CrossedEdges::CrossedEdges(const BlockValues& values, double iso) {
    for (int x = 0; x < kBlockSide; ++x) {
        for (int y = 0; y < kBlockSide; ++y) {
            for (int z = 0; z < kBlockSide; ++z) {
                const bool here = values.at(x, y, z) > iso;
                const bool beyond[] = {values.at(x + 1, y, z) > iso, values.at(x, y + 1, z) > iso,
                                       values.at(x, y, z + 1) > iso};
                for (int axis = 0; axis < 3; ++axis) {
                    if (beyond[axis] == here) continue;
                    const int bit = axis * kNodes + (x * kBlockSide + y) * kBlockSide + z;
                    mCrossed[bit >> 6] |= std::uint64_t(1) << (bit & 63);
                }
            }
        }
    }
    for (int word = 0; word < kWords; ++word) {
        mBefore[word] = static_cast<std::uint16_t>(mCount);
        mCount += std::popcount(mCrossed[word]);
    }
}

SurfacePlace findCrossing(DensityProbe& probe, const LatticeEdge& edge, double iso,
                          double tolerance) {
    // Newton's method, kept within a bracket that halves where it does not help.
    double low = 0, high = 1;
    double t = edge.low / (edge.low - edge.high);
    double lastStep = 1;
    SurfacePlace place;
    for (int step = 0; step < kMostSteps; ++step) {
        t = std::clamp(t, 0.5 * tolerance, 1 - 0.5 * tolerance);
        place.index = edge.node.asVec3d();
        place.index[edge.axis] += t;
        const DensityAt at = probe.evaluate(place.index);
        place.gradient = at.gradient;
        if (isOnSurface(at, iso, tolerance)) break;
        const double above = at.value - iso;
        ((above > 0) == (edge.low > 0) ? low : high) = t;
        if (high - low <= 0.5 * tolerance) break;
        const double newton = t - above / at.gradient[edge.axis];
        const bool isGood = newton > low && newton < high && 2 * std::abs(newton - t) < lastStep;
        const double next = isGood ? newton : 0.5 * (low + high);
        lastStep = std::abs(next - t);
        t = next;
    }
    return place;
}

SurfacePlace projectToSurface(DensityProbe& probe, const openvdb::Vec3d& index, double iso,
                              double tolerance) {
    const DensityAt first = probe.evaluate(index);
    SurfacePlace place{index, first.gradient};
    DensityAt at = first;
    for (int step = 0; step < kMostSteps; ++step) {
        if (isOnSurface(at, iso, tolerance)) return place;
        place.index += (iso - at.value) / at.gradient.lengthSqr() * at.gradient;
        const openvdb::Vec3d moved = place.index - index;
        const bool isNear =
            std::max({std::abs(moved[0]), std::abs(moved[1]), std::abs(moved[2])}) <= 1;
        if (!isNear) break;  // also where the gradient is 0
        at = probe.evaluate(place.index);
        place.gradient = at.gradient;
    }
    return {index, first.gradient};
}

}  // namespace bandvox

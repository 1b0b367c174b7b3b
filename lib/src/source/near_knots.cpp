#include "source/near_knots.h"

#include <cstddef>

namespace bandvox {

void joinNearKnots(BsplineNet& net) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        auto& knots = net.knots[axis];
        const double low = knots[static_cast<std::size_t>(net.degree[axis])];
        const double high = knots[static_cast<std::size_t>(net.count[axis])];
        const double least = kLeastSpan * (high - low);
        double first = knots.front();
        for (double& knot : knots) {
            if (knot - first > least) first = knot;
            knot = first;
            if (knot - low < least && low - knot < least) knot = low;
            if (knot - high < least && high - knot < least) knot = high;
        }
    }
}

}  // namespace bandvox

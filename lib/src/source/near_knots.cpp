#include "source/near_knots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

// How far the surface may move on a stretch that is left out, as a part of its control polygon.
constexpr double kLeastMove = 1e-6;

// Whether knots k and k + 1 are as good as one. A point of the surface moves by no more than the
// stretch between them, as a part of the `degree` stretches from knots[i] that have it among them;
// the first and the last knot have no part in that.
bool areOne(const std::vector<double>& knots, std::size_t k, std::size_t degree, std::size_t count,
            double least) {
    const double gap = knots[k + 1] - knots[k];
    constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
    if (gap <= kRounding * std::max(std::abs(knots[k]), std::abs(knots[k + 1]))) return true;
    if (gap > least) return false;
    for (std::size_t i = std::max(k + 1, degree + 1) - degree; i <= std::min(k, count - 1); ++i) {
        if (gap > kLeastMove * (knots[i + degree] - knots[i])) return false;
    }
    return true;
}

// Returns whether there was anything to join.
bool joinOnce(std::vector<double>& knots, std::size_t degree, std::size_t count) {
    const double low = knots[degree], high = knots[count];
    std::vector<double> joined = knots;
    for (std::size_t first = 0; first < knots.size();) {
        std::size_t last = first;
        while (last + 1 < knots.size() &&
               areOne(knots, last, degree, count, kLeastSpan * (high - low))) {
            ++last;
        }
        double knot = knots[first];
        if (first <= count && count <= last) knot = high;
        if (first <= degree && degree <= last) knot = low;
        for (std::size_t k = first; k <= last; ++k) joined[k] = knot;
        first = last + 1;
    }
    const bool isChanged = joined != knots;
    knots = std::move(joined);
    return isChanged;
}

}  // namespace

void joinNearKnots(BsplineNet& net) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        // Until nothing changes, so that who joins joined knots gets the same.
        while (joinOnce(net.knots[axis], static_cast<std::size_t>(net.degree[axis]),
                        static_cast<std::size_t>(net.count[axis]))) {
        }
    }
}

}  // namespace bandvox

#include "source/near_knots.h"

#include <bandvox/core/error.h>
#include <bandvox/source/bspline_patch.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace bandvox {
namespace {

using Homogeneous = std::array<double, 4>;

// One axis of a net: its knots, and the pieces between them.
struct KnotAxis {
    int degree;
    const std::vector<double>& knots;

    double knot(int k) const { return knots[static_cast<std::size_t>(k)]; }

    // The blossom of the polynomial on knots[span] to knots[span + 1], by de Boor's scheme, at
    // `early` times a and then b. `points`: those that the span depends on, degree + 1.
    Homogeneous blossom(std::vector<Homogeneous> points, int span, std::array<double, 2> ab,
                        int early) const {
        for (int r = 1; r <= degree; ++r) {
            const double t = r <= early ? ab[0] : ab[1];
            for (int j = degree; j >= r; --j) {
                const double low = knot(span - degree + j), high = knot(span + j - r + 1);
                const double share = (t - low) / (high - low);
                auto& point = points[static_cast<std::size_t>(j)];
                const auto& before = points[static_cast<std::size_t>(j) - 1];
                for (std::size_t c = 0; c < 4; ++c) {
                    point[c] = (1 - share) * before[c] + share * point[c];
                }
            }
        }
        return points.back();
    }
};

struct Span {
    int index;
    std::array<double, 2> range;
};

// The spans of joined knots: what the range leaves of one counts if it is not as narrow as what
// joining leaves out, and in a span that is as narrow itself, if it is no such part of that.
std::vector<Span> spansOf(const BsplineNet& net, std::size_t axis) {
    const auto& knots = net.knots[axis];
    const auto [low, high] = net.range[axis];
    const double least = kLeastSpan * (knots[static_cast<std::size_t>(net.count[axis])] -
                                       knots[static_cast<std::size_t>(net.degree[axis])]);
    std::vector<Span> spans;
    for (int k = net.degree[axis]; k < net.count[axis]; ++k) {
        Span span{k, {knots[static_cast<std::size_t>(k)], knots[static_cast<std::size_t>(k) + 1]}};
        const double width = span.range[1] - span.range[0];
        if (low < high) {
            span.range = {std::max(span.range[0], low), std::min(span.range[1], high)};
        }
        const double narrow = width > least ? least : kLeastSpan * width;
        if (span.range[1] - span.range[0] > narrow) spans.push_back(span);
    }
    return spans;
}

void requireValid(const BsplineNet& net) {
    const auto refuse = [](const std::string& found) {
        throw Error(ErrorKind::Usage, "the B-spline surface has " + found);
    };
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const int degree = net.degree[axis];
        if (degree < 1 || degree > BezierPatch::kHighestDegree) {
            refuse("the degree " + std::to_string(degree) + "; expected 1 to " +
                   std::to_string(BezierPatch::kHighestDegree));
        }
        const auto& knots = net.knots[axis];
        const auto expected =
            static_cast<std::size_t>(net.count[axis]) + static_cast<std::size_t>(degree) + 1;
        if (net.count[axis] <= degree || knots.size() != expected) {
            refuse(std::to_string(net.count[axis]) + " control points and " +
                   std::to_string(knots.size()) + " knots along an axis of degree " +
                   std::to_string(degree) + "; expected more points than that, and " +
                   std::to_string(expected) + " knots");
        }
        if (!std::all_of(knots.begin(), knots.end(), [](double k) { return std::isfinite(k); })) {
            refuse("knots that are not finite; expected numbers");
        }
        if (!std::is_sorted(knots.begin(), knots.end())) {
            refuse("knots that descend; expected none");
        }
    }
    const auto expected =
        static_cast<std::size_t>(net.count[0]) * static_cast<std::size_t>(net.count[1]);
    if (net.control.size() != expected) {
        refuse(std::to_string(net.control.size()) + " control points; expected " +
               std::to_string(expected));
    }
}

BezierPatch patchOf(const BsplineNet& net, const Span& across, const Span& along) {
    const KnotAxis u{net.degree[0], net.knots[0]};
    const KnotAxis v{net.degree[1], net.knots[1]};
    BezierPatch patch{.degreeU = u.degree, .degreeV = v.degree};
    patch.control.resize(patch.index(u.degree, v.degree) + 1);
    std::vector<std::vector<Homogeneous>> columns(static_cast<std::size_t>(v.degree) + 1);
    for (int i = across.index - u.degree; i <= across.index; ++i) {
        const auto row = net.control.begin() + static_cast<std::ptrdiff_t>(i) * net.count[1] +
                         along.index - v.degree;
        for (int j = 0; j <= v.degree; ++j) {
            columns[static_cast<std::size_t>(j)].push_back(
                v.blossom({row, row + v.degree + 1}, along.index, along.range, v.degree - j));
        }
    }
    for (int j = 0; j <= v.degree; ++j) {
        for (int i = 0; i <= u.degree; ++i) {
            patch.at(i, j) = u.blossom(columns[static_cast<std::size_t>(j)], across.index,
                                       across.range, u.degree - i);
        }
    }
    return patch;
}

}  // namespace

std::vector<BezierPatch> bezierPatches(const BsplineNet& given) {
    requireValid(given);
    BsplineNet net = given;
    joinNearKnots(net);
    std::vector<BezierPatch> patches;
    const std::vector<Span> along = spansOf(net, 1);
    for (const Span& across : spansOf(net, 0)) {
        for (const Span& other : along) patches.push_back(patchOf(net, across, other));
    }
    return patches;
}

}  // namespace bandvox

// Bézier patches and what B-spline surfaces turn into, against de Boor's recursion.

#include <bandvox/core/error.h>
#include <bandvox/source/bspline_patch.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox {
namespace {

// The basis function by its definition.
double basis(const std::vector<double>& knots, int i, int degree, double t) {
    const auto at = [&](int k) { return knots[static_cast<std::size_t>(k)]; };
    if (degree == 0) return t >= at(i) && t < at(i + 1) ? 1 : 0;
    double value = 0;
    if (at(i + degree) > at(i)) {
        value += (t - at(i)) / (at(i + degree) - at(i)) * basis(knots, i, degree - 1, t);
    }
    if (at(i + degree + 1) > at(i + 1)) {
        value += (at(i + degree + 1) - t) / (at(i + degree + 1) - at(i + 1)) *
                 basis(knots, i + 1, degree - 1, t);
    }
    return value;
}

BsplineNet sampleNet() {
    BsplineNet net;
    net.degree = {3, 2};
    net.count = {6, 5};
    net.knots = {{{-1, 0, 0.5, 1, 1.5, 3, 3, 4, 5, 6}, {0, 0, 0, 1, 2.5, 3, 3, 3}}};
    for (int k = 0; k < 30; ++k) {
        const double w = 1 + 0.5 * std::sin(3.1 * k);
        net.control.push_back(
            {w * (k / 5 + 0.1 * std::sin(k)), w * (k % 5), w * std::cos(2.0 * k), w});
    }
    return net;
}

TEST(BsplinePatch, GivesPatchesThatAreTheSurface) {
    const BsplineNet net = sampleNet();
    const std::vector<BezierPatch> patches = bezierPatches(net);
    // Between u = 1 and 3 there are two spans, and a double knot; between v = 0 and 3 three.
    ASSERT_EQ(patches.size(), 2U * 3U);
    const double us[] = {1, 1.5, 3}, vs[] = {0, 1, 2.5, 3};
    for (std::size_t k = 0; k < patches.size(); ++k) {
        for (const double a : {0.0, 0.3, 0.8}) {
            const double u = us[k / 3] + a * (us[k / 3 + 1] - us[k / 3]);
            const double v = vs[k % 3] + 0.4 * (vs[k % 3 + 1] - vs[k % 3]);
            std::array<double, 4> sum{};
            for (int i = 0; i < 6; ++i) {
                for (int j = 0; j < 5; ++j) {
                    const double b = basis(net.knots[0], i, 3, u) * basis(net.knots[1], j, 2, v);
                    for (std::size_t c = 0; c < 4; ++c) {
                        sum[c] += b * net.control[static_cast<std::size_t>(i * 5 + j)][c];
                    }
                }
            }
            const PatchJet jet = evaluate(patches[k], a, 0.4);
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_NEAR(jet.position[c], sum[c] / sum[3], 1e-12);
            }
        }
    }
}

TEST(BsplinePatch, KeepsToItsRange) {
    BsplineNet net = sampleNet();
    const BezierPatch whole = bezierPatches(net)[0];
    net.range = {{{1.2, 1.4}, {0.25, 0.75}}};
    const std::vector<BezierPatch> part = bezierPatches(net);
    ASSERT_EQ(part.size(), 1U);
    const auto p = evaluate(part[0], 0.5, 0.5).position, q = evaluate(whole, 0.6, 0.5).position;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(p[c], q[c], 1e-12);
}

TEST(BsplinePatch, TakesKnotsThatNearlyAreOneForOne) {
    BsplineNet exact = sampleNet(), near = sampleNet();
    exact.knots[1] = {0, 0, 0, 1, 1, 3, 3, 3};
    near.knots[1] = {0, 1e-13, 2e-13, 1, 1 + 1e-13, 3 - 1e-12, 3, 3 + 1e-13};
    const std::vector<BezierPatch> expected = bezierPatches(exact), found = bezierPatches(near);
    ASSERT_EQ(expected.size(), 2U * 2U);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        for (std::size_t i = 0; i < found[k].control.size(); ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                EXPECT_NEAR(found[k].control[i][c], expected[k].control[i][c], 1e-11);
            }
        }
    }
    // What is a little farther apart are two.
    near.knots[1] = {0, 0, 0, 1, 1 + 1e-6, 3, 3, 3};
    EXPECT_EQ(bezierPatches(near).size(), 2U * 3U);
}

// A line of control points (k, k mod 2) in x and z, of degree 1 along v, with `inner` knots between
// those of the ends, 0 and 1.
BsplineNet ribbon(int degree, const std::vector<double>& inner) {
    const auto order = static_cast<std::size_t>(degree) + 1;
    BsplineNet net;
    net.degree = {degree, 1};
    net.count = {static_cast<int>(inner.size() + order), 2};
    net.knots[0].assign(order, 0);
    net.knots[0].insert(net.knots[0].end(), inner.begin(), inner.end());
    net.knots[0].insert(net.knots[0].end(), order, 1);
    net.knots[1] = {0, 0, 1, 1};
    for (int i = 0; i < net.count[0]; ++i) {
        for (const double y : {0.0, 1.0}) {
            net.control.push_back({static_cast<double>(i), y, static_cast<double>(i % 2), 1});
        }
    }
    return net;
}

double endOf(const BezierPatch& patch, double u) {
    return evaluate(patch, u, 0.5).position[0];
}

// Between more near knots than the degree the surface goes on, as it does between far ones.
TEST(BsplinePatch, KeepsWhatIsBetweenMoreNearKnotsThanItsDegree) {
    struct Case {
        int degree;
        std::vector<double> steps;
        std::size_t patches;
    };
    const std::vector<Case> cases{{1, {0, 1}, 3},       {1, {0, 1, 3}, 4},    {2, {0, 1, 2}, 4},
                                  {2, {0, 0, 1}, 3},    {3, {0, 1, 1, 1}, 3}, {3, {0, 0, 1, 1}, 3},
                                  {2, {0, 1, 1, 2}, 4}, {2, {0, 1e-4, 1}, 4}};
    for (const auto& [degree, steps, count] : cases) {
        for (const double step : {0.1, 1e-8, 1e-10}) {
            std::vector<double> inner;
            for (const double k : steps) inner.push_back(0.5 + step * k);
            const BsplineNet net = ribbon(degree, inner);
            const std::vector<BezierPatch> patches = bezierPatches(net);
            ASSERT_EQ(patches.size(), count) << degree << " " << step;
            double x = 0;
            for (const BezierPatch& patch : patches) {
                EXPECT_NEAR(endOf(patch, 0), x, 1e-12) << degree << " " << step;
                x = endOf(patch, 1);
            }
            EXPECT_NEAR(x, net.count[0] - 1, 1e-12);
        }
    }
}

// As they do in the ends, of which the outermost knot has no part in the surface.
TEST(BsplinePatch, KeepsWhatIsBetweenMoreNearKnotsAtItsEnds) {
    const std::vector<BezierPatch> patches = bezierPatches(ribbon(2, {1e-10, 1 - 1e-10}));
    ASSERT_EQ(patches.size(), 3U);
    EXPECT_NEAR(endOf(patches[0], 1), 1, 1e-9);
    EXPECT_NEAR(endOf(patches[2], 0), 3, 1e-9);
}

TEST(BsplinePatch, IsCutInTwoByMoreEqualKnotsThanItsDegree) {
    const double next = std::nextafter(0.5, 1);
    for (const std::vector<double>& inner :
         {std::vector<double>{0.5, 0.5, 0.5}, {0.5, 0.5, next}}) {
        const std::vector<BezierPatch> patches = bezierPatches(ribbon(2, inner));
        ASSERT_EQ(patches.size(), 2U);
        EXPECT_EQ(endOf(patches[0], 0), 0);
        EXPECT_EQ(endOf(patches[0], 1), 2);
        EXPECT_EQ(endOf(patches[1], 0), 3);
        EXPECT_EQ(endOf(patches[1], 1), 5);
    }
}

TEST(BsplinePatch, KeepsToARangeBetweenNearKnots) {
    BsplineNet net = ribbon(1, {0.5, 0.5 + 0x1p-32});
    net.range[0] = {0.5 + 0x1p-34, 0.5 + 0x1p-33};
    const std::vector<BezierPatch> patches = bezierPatches(net);
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_EQ(endOf(patches[0], 0), 1.25);
    EXPECT_EQ(endOf(patches[0], 1), 1.5);
}

TEST(BsplinePatch, LeavesOutWhatARangeHardlyReaches) {
    BsplineNet net = sampleNet();
    net.range = {{{1, 1.5 + 1e-12}, {1 - 1e-12, 2.5}}};
    EXPECT_EQ(bezierPatches(net).size(), 1U);
}

TEST(BsplinePatch, RefusesCountsThatDoNotMatch) {
    BsplineNet net = sampleNet();
    net.knots[0].pop_back();
    EXPECT_THROW(bezierPatches(net), Error);
    net = sampleNet();
    net.control.pop_back();
    EXPECT_THROW(bezierPatches(net), Error);
    net = sampleNet();
    std::swap(net.knots[1][3], net.knots[1][4]);
    EXPECT_THROW(bezierPatches(net), Error);
}

TEST(BezierPatch, HasTheDerivativesThatDifferencesShow) {
    const BezierPatch patch = bezierPatches(sampleNet())[1];
    constexpr double kStep = 1e-4;
    const double u = 0.37, v = 0.61;
    const PatchJet jet = evaluate(patch, u, v);
    const auto at = [&](double a, double b) {
        return evaluate(patch, u + a * kStep, v + b * kStep).position;
    };
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(jet.du[c], (at(1, 0)[c] - at(-1, 0)[c]) / (2 * kStep), 1e-5);
        EXPECT_NEAR(jet.dv[c], (at(0, 1)[c] - at(0, -1)[c]) / (2 * kStep), 1e-5);
        const double twice = 2 * jet.position[c], square = kStep * kStep;
        EXPECT_NEAR(jet.duu[c], (at(1, 0)[c] - twice + at(-1, 0)[c]) / square, 1e-4);
        EXPECT_NEAR(jet.dvv[c], (at(0, 1)[c] - twice + at(0, -1)[c]) / square, 1e-4);
        EXPECT_NEAR(jet.duv[c],
                    (at(1, 1)[c] - at(1, -1)[c] - at(-1, 1)[c] + at(-1, -1)[c]) / (4 * square),
                    1e-4);
    }
}

TEST(BezierPatch, IsTheSameInPart) {
    const BezierPatch patch = bezierPatches(sampleNet())[2];
    const BezierPatch part = restricted(patch, 0.2, 0.7, 0.1, 0.4);
    const auto p = evaluate(part, 0.4, 0.5).position, q = evaluate(patch, 0.4, 0.25).position;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(p[c], q[c], 1e-13);
}

}  // namespace
}  // namespace bandvox

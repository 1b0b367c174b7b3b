// Curves cut to a face whose loop is known, by straight lines in its parameters.

#include "outline/patches/face_cuts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using Places = std::vector<std::array<double, 2>>;

// A patch of which the polygon of these corners belongs to a face.
FaceTopology polygon(const Places& corners) {
    FaceTopology topology;
    topology.places.resize(1);
    topology.places[0].face = 0;
    topology.faces.resize(1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        topology.faces[0].loops.push_back({corners[i], corners[(i + 1) % corners.size()]});
    }
    return topology;
}

CurvePoint pointAt(double u, double v) {
    CurvePoint point;
    point.patch = 0;
    point.x = point.u = u;
    point.y = point.v = v;
    return point;
}

Curve chain(const Places& places) {
    Curve curve;
    for (const auto& [u, v] : places) curve.points.push_back(pointAt(u, v));
    return curve;
}

CurvePoint onChord(const CurvePoint& a, const CurvePoint& b, double share) {
    return pointAt(a.u + share * (b.u - a.u), a.v + share * (b.v - a.v));
}

const Places kTriangle{{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}};

TEST(CutToFaces, CutsWhereLoopsAreCrossed) {
    const FaceTopology topology = polygon(kTriangle);
    const FaceRegions faces(topology);
    const auto parts = cutToFaces({chain({{0, 0.3}, {0.5, 0.3}, {1, 0.3}})}, &faces, onChord);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_NEAR(parts[0].points.front().u, 0.3, 1e-12);
    EXPECT_NEAR(parts[0].points.back().u, 0.9, 1e-12);
}

TEST(CutToFaces, FindsEveryCutOfAComb) {
    Places comb{{0.01, 0.9}, {0.01, 0.1}};
    constexpr int kTeeth = 60;
    for (int k = 0; k < kTeeth; ++k) {
        const double u = 0.01 + 0.98 * (k + 1) / kTeeth;
        comb.push_back({u - 0.5 / kTeeth, 0.1});
        comb.push_back({u - 0.5 / kTeeth, 0.8});
        comb.push_back({u, 0.8});
        if (k + 1 < kTeeth) comb.push_back({u, 0.1});
    }
    comb.push_back({0.99, 0.9});
    const FaceTopology topology = polygon(comb);
    const FaceRegions faces(topology);
    const auto parts = cutToFaces({chain({{0, 0.5}, {1, 0.5}})}, &faces, onChord);
    EXPECT_EQ(parts.size(), static_cast<std::size_t>(kTeeth));
    for (const Curve& part : parts) {
        EXPECT_TRUE(faces.keeps(0, 0.5 * (part.points.front().u + part.points.back().u), 0.5));
    }
}

// On the loop rounding tells now this, now that.
TEST(CutToFaces, KeepsWhatRunsAlongALoop) {
    const FaceTopology topology = polygon(kTriangle);
    const FaceRegions faces(topology);
    std::mt19937 random(5);
    const PointBetween rounded = [&](const CurvePoint& a, const CurvePoint& b, double share) {
        CurvePoint point = onChord(a, b, share);
        const double off = std::uniform_real_distribution<double>(-1e-15, 1e-15)(random);
        if (point.u > 0.2 && point.u < 0.8) point.v += off;
        return point;
    };
    const auto whole =
        cutToFaces({chain({{0.2, 0.2}, {0.4, 0.4}, {0.6, 0.6}, {0.8, 0.8}})}, &faces, rounded);
    ASSERT_EQ(whole.size(), 1U);
    EXPECT_EQ(whole[0].points.front().u, 0.2);
    EXPECT_EQ(whole[0].points.back().u, 0.8);

    // It comes from outside, and leaves into the face.
    const auto parts =
        cutToFaces({chain({{0.1, 0.5}, {0.4, 0.4}, {0.6, 0.6}, {0.7, 0.3}})}, &faces, rounded);
    ASSERT_FALSE(parts.empty());
    double length = 0;
    for (const Curve& part : parts) {
        for (std::size_t i = 1; i < part.points.size(); ++i) {
            const CurvePoint &p = part.points[i - 1], &q = part.points[i];
            length += std::hypot(q.u - p.u, q.v - p.v);
        }
    }
    EXPECT_NEAR(length, std::hypot(0.2, 0.2) + std::hypot(0.1, 0.3), 1e-6);
    EXPECT_EQ(parts.back().points.back().u, 0.7);
}

TEST(CutToFaces, AsksForNoRowOfWhatIsNoNumber) {
    const FaceTopology topology = polygon(kTriangle);
    const FaceRegions faces(topology);
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(faces.keeps(0, 0.5, none));
    EXPECT_FALSE(faces.keeps(0, none, none));
}

}  // namespace
}  // namespace bandvox

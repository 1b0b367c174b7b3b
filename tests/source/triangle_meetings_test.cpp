#include "source/triangle_meetings.h"

#include "source/box_pairs.h"
#include "source/point_lists.h"
#include "source/test_meshes.h"
#include "source/unfolded_stars.h"
#include "source/weld_points.h"

#include <bandvox/core/parallel.h>
#include <bandvox/core/progress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;
using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Found = std::set<std::tuple<std::uint32_t, std::uint32_t, bool>>;

std::vector<TriangleMeeting> meetingsOf(const Mesh& mesh) {
    return findMeetings(mesh, silentProgress());
}

// Two triangles of a mesh as one of their own: nothing is closed there, so each pair is looked at.
Mesh alone(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
    Mesh two;
    two.points = mesh.points;
    two.triangles = {mesh.triangles[a], mesh.triangles[b]};
    removeUnusedPoints(two);
    return two;
}

Found pairByPair(const Mesh& mesh) {
    Found found;
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
        for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
            for (const TriangleMeeting& m : meetingsOf(alone(mesh, a, b))) {
                found.emplace(a, b, m.coplanar);
            }
        }
    }
    return found;
}

Found allAtOnce(const Mesh& mesh) {
    Found found;
    for (const TriangleMeeting& m : meetingsOf(mesh)) found.emplace(m.first, m.second, m.coplanar);
    return found;
}

// A ball of few triangles whose points are moved about: the more, the more of it folds over.
Mesh crumpledBall(unsigned seed, double by) {
    constexpr unsigned kRows = 8, kColumns = 9;
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-by, by);
    for (unsigned row = 1; row < kRows; ++row) {
        for (unsigned column = 0; column < kColumns; ++column) {
            const double t = std::numbers::pi * row / kRows;
            const double p = 2 * std::numbers::pi * column / kColumns;
            mesh.points.emplace_back(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p),
                                     std::cos(t));
        }
    }
    const auto at = [](unsigned row, unsigned column) {
        return (row - 1) * kColumns + column % kColumns;
    };
    const auto north = static_cast<unsigned>(mesh.points.size()), south = north + 1;
    mesh.points.emplace_back(0, 0, 1);
    mesh.points.emplace_back(0, 0, -1);
    for (unsigned c = 0; c < kColumns; ++c) {
        mesh.triangles.emplace_back(north, at(1, c), at(1, c + 1));
        mesh.triangles.emplace_back(south, at(kRows - 1, c + 1), at(kRows - 1, c));
        for (unsigned row = 1; row + 1 < kRows; ++row) {
            mesh.triangles.emplace_back(at(row, c), at(row + 1, c), at(row, c + 1));
            mesh.triangles.emplace_back(at(row, c + 1), at(row + 1, c), at(row + 1, c + 1));
        }
    }
    for (Vec3d& p : mesh.points) p += Vec3d(move(random), move(random), move(random));
    return mesh;
}

// Triangles between few points, so that many share some, and some have no area.
Mesh tangle(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, 4);
    std::uniform_int_distribution<unsigned> corner(0, 19);
    Mesh mesh;
    for (int i = 0; i < 20; ++i) {
        mesh.points.emplace_back(place(random), place(random), place(random));
    }
    for (int i = 0; i < 40; ++i) {
        mesh.triangles.emplace_back(corner(random), corner(random), corner(random));
    }
    std::erase_if(mesh.triangles,
                  [](const Vec3I& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    return mesh;
}

TEST(TriangleMeetings, AreThoseOfAllPairsOnABall) {
    for (const double by : {0.0, 0.05, 0.2, 0.6}) {
        const Mesh mesh = crumpledBall(7, by);
        const Found found = allAtOnce(mesh);
        EXPECT_EQ(found, pairByPair(mesh)) << by;
        EXPECT_EQ(found.empty(), by < 0.3) << by;
    }
}

TEST(TriangleMeetings, AreThoseOfAllPairsInATangle) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Mesh mesh = tangle(seed);
        const Found found = allAtOnce(mesh);
        EXPECT_FALSE(found.empty());
        EXPECT_EQ(found, pairByPair(mesh)) << seed;
    }
}

TEST(TriangleMeetings, AreTheSameFarFromTheOriginAndForAnyNumberOfThreads) {
    const Mesh mesh = crumpledBall(3, 0.4);
    Mesh far = mesh;
    // Halves, so that moving rounds nothing that was not rounded before.
    for (Vec3d& p : far.points) {
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 4096) / 4096;
    }
    const Found expected = allAtOnce(far);
    EXPECT_FALSE(expected.empty());
    for (Vec3d& p : far.points) p += Vec3d(1 << 30, -(1 << 29), 1 << 28);
    EXPECT_EQ(allAtOnce(far), expected);
    const Found here = allAtOnce(mesh);
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(allAtOnce(mesh), here);
    }
}

TEST(TriangleMeetings, ThereAreNoneInAMeshWithoutTriangles) {
    EXPECT_TRUE(meetingsOf(Mesh()).empty());
}

TEST(BoxPairs, AreAllThatMeetEachOnce) {
    for (const int count : {1, 2, 16, 17, 33, 300}) {
        const Mesh mesh = test::soup(5, count);
        const auto boxOf = [&](std::uint32_t t) {
            openvdb::BBoxd box;
            for (int k = 0; k < 3; ++k) box.expand(mesh.points[mesh.triangles[t][k]]);
            return box;
        };
        std::set<Pair> expected;
        for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
            for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
                if (boxOf(a).hasOverlap(boxOf(b))) expected.emplace(a, b);
            }
        }
        const BoxPairs boxes(mesh);
        std::vector<Pair> pairs;
        for (std::size_t leaf = 0; leaf < boxes.leafCount(); ++leaf) {
            boxes.appendPairs(leaf, pairs);
        }
        std::set<Pair> found;
        for (const Pair& pair : pairs) found.insert(std::minmax(pair.first, pair.second));
        EXPECT_EQ(found.size(), pairs.size());
        // Rounding may add a few of those that nearly meet.
        EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
        EXPECT_LE(found.size(), expected.size() + 2) << count;
    }
}

TEST(BoxPairs, OfTrianglesAllInOnePlaceAreAllPairs) {
    Mesh mesh;
    mesh.points.assign(3, Vec3d(2, 3, 5));
    mesh.triangles.assign(40, Vec3I(0, 1, 2));
    const BoxPairs boxes(mesh);
    std::vector<Pair> pairs;
    for (std::size_t leaf = 0; leaf < boxes.leafCount(); ++leaf) boxes.appendPairs(leaf, pairs);
    EXPECT_EQ(pairs.size(), 40U * 39 / 2);
}

TEST(BoxPairs, LeaveOutTrianglesThatShareASettledPoint) {
    const Mesh mesh = crumpledBall(3, 0.05);
    std::vector<std::uint8_t> settled(mesh.points.size());
    for (std::size_t p = 0; p < settled.size(); ++p) settled[p] = p % 3 == 0 ? 1 : 0;
    const auto pairsOf = [](const BoxPairs& boxes) {
        std::vector<Pair> pairs;
        for (std::size_t leaf = 0; leaf < boxes.leafCount(); ++leaf) boxes.appendPairs(leaf, pairs);
        return std::set<Pair>(pairs.begin(), pairs.end());
    };
    std::set<Pair> expected = pairsOf(BoxPairs(mesh));
    const std::size_t all = expected.size();
    std::erase_if(expected, [&](const Pair& pair) {
        const Vec3I &a = mesh.triangles[pair.first], &b = mesh.triangles[pair.second];
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                if (a[i] == b[k] && settled[a[i]] != 0) return true;
            }
        }
        return false;
    });
    EXPECT_GT(all, expected.size());
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(pairsOf(BoxPairs(mesh, settled)), expected);
}

TEST(UnfoldedStars, HaveNoMeetings) {
    std::size_t unfolded = 0, others = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Mesh mesh = crumpledBall(seed, 0.02 * seed);
        const std::vector<std::uint8_t> stars = findUnfoldedStars(mesh, certainFacings(mesh));
        for (const TriangleMeeting& m : meetingsOf(mesh)) {
            for (int i = 0; i < 3; ++i) {
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t point = mesh.triangles[m.first][i];
                    if (point != mesh.triangles[m.second][k]) continue;
                    EXPECT_EQ(stars[point], 0) << seed << " " << point;
                }
            }
        }
        const auto count = static_cast<std::size_t>(std::count(stars.begin(), stars.end(), 1));
        unfolded += count;
        others += stars.size() - count;
    }
    EXPECT_GT(unfolded, 300U);
    EXPECT_GT(others, 100U);
}

TEST(UnfoldedStars, AreThoseOfAFlatFanButNotOfTwoTurnsOrAnOpenOne) {
    const auto fan = [](unsigned corners, int turns) {
        Mesh mesh;
        mesh.points.emplace_back(0, 0, 0);
        for (unsigned i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * turns * i / corners;
            mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0.1 * i);
            mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % corners);
        }
        return mesh;
    };
    const auto isUnfolded = [](const Mesh& mesh) {
        return findUnfoldedStars(mesh, certainFacings(mesh))[0] != 0;
    };
    EXPECT_TRUE(isUnfolded(fan(5, 1)));
    EXPECT_TRUE(isUnfolded(test::reversed(fan(5, 1))));
    EXPECT_FALSE(isUnfolded(fan(9, 2)));
    Mesh open = fan(5, 1);
    open.triangles.pop_back();
    EXPECT_FALSE(isUnfolded(open));
}

TEST(PointLists, AreInOrderForAnyNumberOfThreads) {
    Mesh mesh;
    constexpr unsigned kPoints = 70000;
    std::mt19937 random(1);
    std::uniform_int_distribution<unsigned> corner(0, kPoints - 1);
    mesh.points.resize(kPoints);
    for (int i = 0; i < 50000; ++i) {
        mesh.triangles.emplace_back(corner(random), corner(random), corner(random));
    }
    std::vector<std::vector<std::uint32_t>> expected(kPoints);
    for (std::uint32_t i = 0; i < 3 * mesh.triangles.size(); ++i) {
        expected[mesh.triangles[i / 3][i % 3]].push_back(i);
    }
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        const PointLists lists =
            listByPoint<3>(mesh.triangles, kPoints, [](const Vec3I& t, int k) { return t[k]; });
        for (unsigned p = 0; p < kPoints; ++p) {
            const auto list = lists.of(p);
            ASSERT_TRUE(
                std::equal(list.begin(), list.end(), expected[p].begin(), expected[p].end()))
                << p;
        }
    }
}

}  // namespace
}  // namespace bandvox

#include "soup_meshes.h"
#include "source/winding_tree.h"

#include <bandvox/core/parallel.h>
#include <bandvox/source/winding_number.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

Mesh noisyBall() {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 60, 90);
    std::mt19937 random(7);
    std::uniform_real_distribution<> uniform(0.8, 1.2);
    for (Vec3d& p : mesh.points) p *= uniform(random);
    return mesh;
}

struct Case {
    const char* name;
    Mesh mesh;
};

std::vector<Case> cases() {
    return {{"ball", test::sphere(Vec3d(0.0), 1, 40, 60)},
            {"noisy ball", noisyBall()},
            {"panels", test::askew(test::panels(0.1))},
            {"shreds", test::shredded(test::sphere(Vec3d(0.0), 1, 40, 60), 0.2)},
            {"half of a ball", test::thinned(test::sphere(Vec3d(0.0), 1, 40, 60), 0.5, 3)},
            {"one triangle", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}}}};
}

// Places around and within a mesh, a third of them near its triangles.
std::vector<Vec3d> placesAround(const Mesh& mesh, int count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<> uniform(-1.5, 1.5);
    std::uniform_int_distribution<std::size_t> point(0, mesh.points.size() - 1);
    std::vector<Vec3d> places;
    for (int i = 0; i < count; ++i) {
        const Vec3d offset(uniform(random), uniform(random), uniform(random));
        places.push_back(i % 3 == 0 ? mesh.points[point(random)] + 0.02 * offset : offset);
    }
    return places;
}

TEST(WindingNumber, OfAClosedSurfaceIsWhole) {
    const WindingNumber winding(test::askew(test::cube(Vec3d(-1.0), 2)));
    EXPECT_NEAR(winding.exactAt(Vec3d(0.1, 0.2, -0.3)), 1, 1e-14);
    EXPECT_NEAR(winding.exactAt(Vec3d(2, 0.2, -0.3)), 0, 1e-14);
    const WindingNumber inward(test::reversed(noisyBall()));
    EXPECT_NEAR(inward.exactAt(Vec3d(0.1, 0.2, -0.3)), -1, 1e-12);
}

TEST(WindingNumber, IsHalfInAPlaneOpening) {
    // A hemisphere's edge is a circle, and from within its plane it takes up half of the view.
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 80, 120);
    std::erase_if(mesh.triangles, [&](const openvdb::Vec3I& t) {
        return mesh.points[t[0]].y() + mesh.points[t[1]].y() + mesh.points[t[2]].y() > 1e-9;
    });
    const WindingNumber winding(mesh);
    for (const double r : {0.0, 0.3, 0.9}) {
        EXPECT_NEAR(winding.exactAt(Vec3d(r, 0, 0.1)), 0.5, 1e-12) << r;
        EXPECT_NEAR(winding.at(Vec3d(r, 0, 0.1)), 0.5, 1e-3) << r;
    }
}

TEST(WindingNumber, KeepsToTheExactSum) {
    for (const Case& c : cases()) {
        const WindingNumber winding(c.mesh);
        double largest = 0;
        for (const Vec3d& place : placesAround(c.mesh, 600)) {
            largest = std::max(largest, std::abs(winding.at(place) - winding.exactAt(place)));
        }
        EXPECT_LT(largest, 1e-3) << c.name;
    }
}

// Groups that are further away, relative to their size, are wrong by the third power of that and
// more, since their moments are right to the second order.
TEST(WindingNumber, TheErrorFallsWithTheDistanceOfGroups) {
    const Mesh mesh = noisyBall();
    const WindingNumber winding(mesh);
    const std::vector<Vec3d> places = placesAround(mesh, 300);
    const auto error = [&](double farAway) {
        WindingTerms terms;
        double sum = 0;
        for (const Vec3d& place : places) {
            winding.tree().collect({place, 0.0}, farAway, terms);
            sum += std::pow(terms.at(place) - winding.exactAt(place), 2);
        }
        return std::sqrt(sum / static_cast<double>(places.size()));
    };
    const double near = error(2), middle = error(4), far = error(8);
    EXPECT_LT(near, 5e-3);
    EXPECT_LT(middle, near / 8);
    EXPECT_LT(far, middle / 6);
}

TEST(WindingNumber, TermsHoldForAWholeRegion) {
    const Mesh mesh = noisyBall();
    const WindingNumber winding(mesh);
    std::mt19937 random(5);
    std::uniform_real_distribution<> uniform(-1, 1);
    for (const Vec3d& center : placesAround(mesh, 30)) {
        WindingTerms terms;
        winding.tree().collect({center, 0.1}, 2, terms);
        for (int i = 0; i < 20; ++i) {
            Vec3d offset(uniform(random), uniform(random), uniform(random));
            offset *= 0.1 / std::max(1.0, offset.length());
            EXPECT_NEAR(terms.at(center + offset), winding.exactAt(center + offset), 1e-2);
        }
    }
}

TEST(WindingNumber, DoesNotMindScaleOrPlace) {
    const Mesh mesh = test::askew(test::panels(0.1));
    const WindingNumber winding(mesh);
    for (const auto& [scale, shift] :
         {std::pair(1e-6, 0.0), {1e6, 0.0}, {1.0, 1e5}, {1e-3, 10.0}}) {
        Mesh moved = mesh;
        for (Vec3d& p : moved.points) p = scale * p + Vec3d(shift);
        const WindingNumber there(moved);
        for (const Vec3d& place : placesAround(mesh, 60)) {
            EXPECT_NEAR(there.at(scale * place + Vec3d(shift)), winding.at(place), 1e-3)
                << scale << " " << shift;
        }
    }
}

TEST(WindingNumber, TakesWhatHasNoAreaAndNothing) {
    const WindingNumber nothing{Mesh()};
    EXPECT_EQ(nothing.at(Vec3d(1.0)), 0);
    EXPECT_EQ(nothing.exactAt(Vec3d(1.0)), 0);
    Mesh mesh = test::cube(Vec3d(-1.0), 2);
    for (int i = 0; i < 20; ++i) mesh.triangles.emplace_back(0, 0, i % 8);
    const WindingNumber winding(mesh);
    EXPECT_NEAR(winding.at(Vec3d(0.0)), 1, 1e-3);
    EXPECT_NEAR(winding.at(Vec3d(5.0)), 0, 1e-3);
    const WindingNumber point({{{1, 1, 1}}, {{0, 0, 0}}});
    EXPECT_EQ(point.at(Vec3d(0.0)), 0);
    EXPECT_TRUE(std::isfinite(point.at(Vec3d(1.0))));
}

TEST(WindingNumber, OnASurfaceIsTheMeanOfBothSides) {
    const WindingNumber winding(test::cube(Vec3d(-1.0), 2));
    EXPECT_NEAR(winding.exactAt(Vec3d(1, 0.3, 0.2)), 0.5, 1e-12);
    EXPECT_TRUE(std::isfinite(winding.at(Vec3d(1, 1, 1))));
}

TEST(WindingTree, BoundsTheGradient) {
    for (const Case& c : cases()) {
        const WindingNumber winding(c.mesh);
        for (const Vec3d& place : placesAround(c.mesh, 40)) {
            const WindingRegion region{place, 0.05};
            const double bound = winding.tree().gradientBound(region, HUGE_VAL);
            if (!std::isfinite(bound) ||
                winding.tree().mayMeet({place - Vec3d(0.05), place + Vec3d(0.05)})) {
                continue;
            }
            for (int axis = 0; axis < 3; ++axis) {
                Vec3d step(0.0);
                step[axis] = 0.05;
                const double change = winding.exactAt(place + step) - winding.exactAt(place - step);
                EXPECT_LE(std::abs(change), 0.1 * bound + 1e-12) << c.name;
            }
        }
    }
}

TEST(WindingTree, IsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = test::soup(noisyBall());
    const auto valuesWith = [&](int threads) {
        const ThreadLimit limit(threads);
        const WindingNumber winding(mesh);
        std::vector<double> values;
        for (const Vec3d& place : placesAround(mesh, 50)) values.push_back(winding.at(place));
        return values;
    };
    EXPECT_EQ(valuesWith(1), valuesWith(3));
}

}  // namespace
}  // namespace bandvox

#include "render/facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

const double kRoughness[] = {0.1, 0.3, 0.6, 1};
const double kReflectance[] = {0, 0.04, 0.5, 1};
const double kCosines[] = {0.02, 0.1, 0.35, 0.6, 0.9, 1};

Vec3d directionOf(double cosine, double around = 0) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(around), sine * std::sin(around), cosine};
}

// ∫ f dω over the hemisphere by midpoints.
template <typename Function>
double overHemisphere(const Function& f) {
    constexpr int kSteps = 2000, kAround = 64;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double polar = 0.5 * pi * (i + 0.5) / kSteps;
        double ring = 0;
        for (int j = 0; j < kAround; ++j) {
            ring += f(directionOf(std::cos(polar), 2 * pi * (j + 0.5) / kAround));
        }
        sum += ring * std::sin(polar);
    }
    return sum * pi * pi / (kSteps * kAround);
}

TEST(LocalFrame, HasThreeAxesAtRightAngles) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1e-9, 0, -1}};
    for (int i = 0; i < 100; ++i) {
        normals.push_back(Vec3d(normal(random), normal(random), normal(random)).unit());
    }
    for (const Vec3d& n : normals) {
        const LocalFrame frame(n);
        const Vec3d x = frame.toWorld({1, 0, 0}), y = frame.toWorld({0, 1, 0});
        EXPECT_LT((frame.toWorld({0, 0, 1}) - n).length(), 1e-12);
        EXPECT_LT((x.cross(y) - n).length(), 1e-7);
        EXPECT_NEAR(x.length(), 1, 1e-7);
        EXPECT_NEAR(y.length(), 1, 1e-7);
        const Vec3d v(0.3, -0.7, 0.2);
        EXPECT_LT((frame.toWorld(frame.toLocal(v)) - v).length(), 1e-7);
    }
}

TEST(Facets, CoverTheSurfaceOnce) {
    for (const double roughness : kRoughness) {
        const Facets facets(roughness);
        EXPECT_FALSE(facets.areEven());
        const double covered =
            overHemisphere([&](const Vec3d& h) { return facets.density(h) * h[2]; });
        EXPECT_NEAR(covered, 1, 1e-3) << roughness;
    }
    EXPECT_TRUE(Facets(0).areEven());
    EXPECT_TRUE(Facets(Facets::kSmallest).areEven());
}

// B. Smith's shadowing is what makes facets that are seen cover what is seen of the surface.
TEST(Facets, CoverWhatIsSeenFromAnywhere) {
    for (const double roughness : kRoughness) {
        const Facets facets(roughness);
        for (const double cosine : kCosines) {
            const Vec3d out = directionOf(cosine);
            const double alone = facets.seenFromBoth(cosine, 1);  // nothing is hidden from above
            const double seen = overHemisphere([&](const Vec3d& h) {
                return alone * std::max(h.dot(out), 0.0) * facets.density(h);
            });
            EXPECT_NEAR(seen / cosine, 1, 1e-3) << roughness << " " << cosine;
        }
    }
}

TEST(Facets, AreDrawnAsTheyAreSeen) {
    // Means of moments of drawn facets against their integrals.
    const auto moments = [](const Vec3d& h) {
        return std::vector<double>{h[0],        h[2],        h[0] * h[0],       h[1] * h[1],
                                   h[0] * h[2], h[1] * h[0], h[2] * h[2] * h[2]};
    };
    constexpr int kSide = 256;
    for (const double roughness : kRoughness) {
        const Facets facets(roughness);
        for (const double cosine : kCosines) {
            const Vec3d out = directionOf(cosine);
            std::vector<double> found(7, 0.0);
            for (int i = 0; i < kSide * kSide; ++i) {
                const Vec3d half =
                    facets.sample(out, {(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
                ASSERT_NEAR(half.length(), 1, 1e-9);
                ASSERT_GT(half[2], 0);
                ASSERT_GT(half.dot(out), -1e-9);
                const auto of = moments(half);
                for (int m = 0; m < 7; ++m) found[m] += of[m] / (kSide * kSide);
            }
            const double alone = facets.seenFromBoth(cosine, 1);
            for (int m = 0; m < 7; ++m) {
                const double expected = overHemisphere([&](const Vec3d& h) {
                    const double seen = alone * std::max(h.dot(out), 0.0) / cosine;
                    return seen * facets.density(h) * moments(h)[m];
                });
                EXPECT_NEAR(found[m], expected, 1e-3) << roughness << " " << cosine << " " << m;
            }
        }
    }
}

TEST(Facets, HideEachOtherAlikeBothWays) {
    for (const double roughness : kRoughness) {
        const Facets facets(roughness);
        for (const double a : kCosines) {
            for (const double b : kCosines) {
                const double both = facets.seenFromBoth(a, b);
                EXPECT_DOUBLE_EQ(both, facets.seenFromBoth(b, a));
                EXPECT_GT(both, 0);
                EXPECT_LE(both, 1);
                // Both is what is seen from one, and of that what is seen from the other.
                EXPECT_NEAR(both, facets.seenFromIn(a, b) * facets.seenFromBoth(a, 1), 1e-12);
            }
        }
    }
    EXPECT_EQ(Facets(0).seenFromIn(0.1, 0.2), 1);
}

TEST(Fresnel, HasItsLimits) {
    for (const double ratio : {1 / 2.4, 1 / 1.5, 1.0 + 1e-12, 1.33, 1.5, 4.0}) {
        const double straight = (ratio - 1) / (ratio + 1);
        EXPECT_NEAR(fresnel(1, ratio), straight * straight, 1e-14);
        EXPECT_NEAR(fresnel(1e-7, ratio), 1, ratio > 1.1 || ratio < 0.9 ? 1e-5 : 1.1);
        for (double cosine = 0.01; cosine < 1; cosine += 0.01) {
            const double reflected = fresnel(cosine, ratio);
            EXPECT_GE(reflected, 0);
            EXPECT_LE(reflected, 1);
            const double sine2 = (1 - cosine * cosine) / (ratio * ratio);
            EXPECT_EQ(reflected == 1, sine2 >= 1) << ratio << " " << cosine;
            // The same from the other side.
            if (sine2 < 1) {
                EXPECT_NEAR(fresnel(std::sqrt(1 - sine2), 1 / ratio), reflected, 1e-9);
            }
        }
    }
    for (double cosine = 0.05; cosine <= 1; cosine += 0.05)
        EXPECT_NEAR(fresnel(cosine, 1), 0, 1e-20);
}

TEST(Fresnel, IsHalfOfOnePolarizationAtBrewstersAngle) {
    for (const double ratio : {1 / 1.5, 1.33, 1.5, 3.0}) {
        // There tan θ = ratio, and of light along the plane nothing is reflected.
        const double cosine = 1 / std::sqrt(1 + ratio * ratio);
        const double across = (1 - ratio * ratio) / (1 + ratio * ratio);
        EXPECT_NEAR(fresnel(cosine, ratio), 0.5 * across * across, 1e-12);
    }
}

TEST(Schlick, GoesFromStraightToAll) {
    for (const double straight : kReflectance) {
        EXPECT_DOUBLE_EQ(schlick(straight, 1), straight);
        EXPECT_DOUBLE_EQ(schlick(straight, 0), 1);
    }
    // C. Schlick's (1994) error for glass.
    for (double cosine = 0; cosine <= 1; cosine += 0.01) {
        EXPECT_NEAR(schlick(0.04, std::max(cosine, 1e-6)), fresnel(std::max(cosine, 1e-6), 1.5),
                    0.04);
    }
}

TEST(Refraction, ObeysSnellAndGoesBothWays) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0, 1);
    int bent = 0, reflected = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3d out = directionOf(0.02 + 0.97 * uniform(random), 6 * uniform(random));
        const Vec3d half = directionOf(0.5 + 0.5 * uniform(random), 6 * uniform(random));
        if (out.dot(half) <= 0) continue;
        const double ratio = i % 2 ? 1 + uniform(random) : 1 / (1 + uniform(random));
        Vec3d through;
        const double sine = out.cross(half).length();
        if (!refract(out, half, ratio, through)) {
            EXPECT_GE(sine / ratio, 1);
            EXPECT_EQ(fresnel(out.dot(half), ratio), 1);
            ++reflected;
            continue;
        }
        ++bent;
        EXPECT_NEAR(through.length(), 1, 1e-12);
        EXPECT_LT(through.dot(half), 0);
        EXPECT_NEAR(ratio * through.cross(half).length(), sine, 1e-12);
        EXPECT_NEAR(through.dot(out.cross(half)), 0, 1e-12);  // in the same plane
        Vec3d back;
        ASSERT_TRUE(refract(through, -half, 1 / ratio, back));
        EXPECT_LT((back - out).length(), 1e-7);
    }
    EXPECT_GT(bent, 100);
    EXPECT_GT(reflected, 10);
}

// With a white ground nothing of the light from around is lost.
TEST(CoatReflectance, LeavesToTheGroundWhatItDoesNotReflect) {
    constexpr int kSide = 128, kAngles = 4000;
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
        const Facets facets(roughness);
        for (const double reflectance : kReflectance) {
            const CoatReflectance coat(facets, reflectance);
            for (double cosine = 0.05; cosine <= 1; cosine += 0.0497) {
                const Vec3d out = directionOf(cosine);
                double mirrored = 0;
                for (int i = 0; i < kSide * kSide; ++i) {
                    const Vec3d half =
                        facets.sample(out, {(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
                    const Vec3d in = reflect(out, half);
                    if (in[2] <= 0 || reflectance == 0) continue;
                    mirrored += schlick(reflectance, out.dot(half)) *
                                facets.seenFromIn(out[2], in[2]) / (kSide * kSide);
                }
                double ground = 0;  // ∫ ground cos dω / π = 2 ∫ ground μ dμ
                for (int i = 0; i < kAngles; ++i) {
                    const double in = (i + 0.5) / kAngles;
                    ground += 2 * coat.ground(cosine, in) * in / kAngles;
                }
                EXPECT_GE(coat.coat(cosine), 0);
                EXPECT_LE(coat.coat(cosine), 1);
                EXPECT_NEAR(mirrored, coat.coat(cosine), 1e-3)
                    << roughness << " " << reflectance << " " << cosine;
                EXPECT_NEAR(ground, coat.groundOfAll(cosine), 1e-4);
                EXPECT_NEAR(mirrored + ground, 1, reflectance == 1 ? 1.0 : 1e-3)
                    << roughness << " " << reflectance << " " << cosine;
                // The same both ways.
                EXPECT_DOUBLE_EQ(coat.ground(cosine, 0.3), coat.ground(0.3, cosine));
            }
        }
    }
    const CoatReflectance mirror(Facets(0), 1);
    EXPECT_EQ(mirror.ground(0.5, 0.7), 0);
    EXPECT_EQ(mirror.groundOfAll(0.5), 0);
    EXPECT_NEAR(mirror.coat(0.5), 1, 1e-12);
}

TEST(Directions, AreSpreadByTheCosine) {
    constexpr int kSide = 200;
    Vec3d mean(0.0), square(0.0);
    for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2d u((i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide);
        const Vec3d d = cosineDirection(u);
        ASSERT_NEAR(d.length(), 1, 1e-12);
        ASSERT_LE(placeInDisk(u).length(), 1 + 1e-12);
        mean += d / (kSide * kSide);
        square += d * d / (kSide * kSide);
    }
    EXPECT_LT((mean - Vec3d(0, 0, 2.0 / 3)).length(), 4e-4);
    EXPECT_LT((square - Vec3d(0.25, 0.25, 0.5)).length(), 1e-4);
    EXPECT_EQ(placeInDisk({0.5, 0.5}), Vec2d(0, 0));
}

}  // namespace
}  // namespace bandvox

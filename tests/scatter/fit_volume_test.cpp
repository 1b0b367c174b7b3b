#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/scatter/fit_volume.h>
#include <bandvox/scatter/spline_volume_to_grids.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using SpaceFunction = std::function<double(double, double, double)>;

double wave(double x, double y, double z) {
    return std::sin(4 * x) * std::cos(3 * y) * std::sin(2 * z + 1);
}

double ball(double x, double y, double z) {
    return std::exp(-8 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) + (z - 0.5) * (z - 0.5)));
}

double quadratic(double x, double y, double z) {
    return 1 + 2 * x - y + z + x * y - 0.5 * z * z + 3 * x * z;
}

/// Random places of the unit cube.
ScatteredPoints randomInCube(std::size_t count, std::uint32_t seed, const SpaceFunction& f) {
    std::mt19937 generator(seed);
    const auto next = [&] { return generator() / 4294967296.0; };
    ScatteredPoints points;
    for (std::size_t i = 0; i < count; ++i) {
        points.x.push_back(next());
        points.y.push_back(next());
        points.z.push_back(next());
        points.values.push_back(f(points.x[i], points.y[i], points.z[i]));
    }
    return points;
}

double largestLeft(const SplineVolume& volume, const ScatteredPoints& points) {
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int c = 0; c < points.columns; ++c) {
            const double value = volume.value({points.x[i], points.y[i], points.z[i]}, c);
            largest = std::max(largest, std::abs(value - points.value(i, c)));
        }
    }
    return largest;
}

/// The root of the mean square of the errors at places a tenth inside the unit cube.
double rmsInside(const SplineVolume& volume, const SpaceFunction& f) {
    double sum = 0;
    int count = 0;
    constexpr int kSteps = 13;
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            for (int k = 0; k <= kSteps; ++k) {
                const auto at = [](int n) { return 0.1 + 0.8 * n / kSteps; };
                const double error = volume.value({at(i), at(j), at(k)}) - f(at(i), at(j), at(k));
                sum += error * error;
                ++count;
            }
        }
    }
    return std::sqrt(sum / count);
}

ErrorKind errorKindOf(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::Runtime;
}

TEST(FitVolume, TakesValuesOfWavesAndBalls) {
    // Measured: 2.4e-3, 1.1e-4 and 1.7e-6 for the wave.
    const std::vector<std::pair<std::size_t, double>> sweep{
        {200, 8e-3}, {1000, 4e-4}, {8000, 1e-5}};
    for (const auto& f : {wave, ball}) {
        double before = 1;
        for (const auto& [count, allowed] : sweep) {
            const ScatteredPoints points = randomInCube(count, 5, f);
            const VolumeFit fit = fitVolume(points);
            EXPECT_EQ(fit.points, count);
            EXPECT_LE(fit.largest, 1e-12);
            EXPECT_LE(fit.rms, fit.largest);
            EXPECT_LE(largestLeft(fit.volume, points), 2e-12);
            const double error = rmsInside(fit.volume, f);
            EXPECT_LE(error, allowed) << count;
            // Four times as many points halve their distance by 1.6; the order is 3 at least.
            EXPECT_LE(error, before / 8) << count;
            before = error;
        }
    }
}

TEST(FitVolume, GoesOnAsQuadraticsDo) {
    const ScatteredPoints points = randomInCube(500, 2, quadratic);
    FitVolumeOptions options;
    options.tension = 0.01;
    const VolumeFit fit = fitVolume(points, options);
    // Third differences of quadratics, whose range is 6 here, are 0, at the border too.
    EXPECT_LE(rmsInside(fit.volume, quadratic), 2e-3);
    EXPECT_NEAR(fit.volume.value({-0.05, -0.05, -0.05}), quadratic(-0.05, -0.05, -0.05), 0.1);
}

TEST(FitVolume, IsSmooth) {
    const VolumeFit fit = fitVolume(randomInCube(300, 3, ball));
    // Second differences of steps h are h² times a continuous function: no jump at knots.
    constexpr double h = 1e-4;
    double before = 0;
    for (int i = 0; i < 2000; ++i) {
        const double x = 0.3 + h * i;
        const auto at = [&](double shift) { return fit.volume.value({x + shift, 0.41, 0.57}); };
        const double second = (at(h) - 2 * at(0) + at(-h)) / (h * h);
        if (i > 0) {
            EXPECT_LE(std::abs(second - before), 2) << x;
        }
        before = second;
    }
}

TEST(FitVolume, HasTheGradientOfItsValues) {
    // Crowds of points, so that finer nets and bumps take a part.
    ScatteredPoints points = randomInCube(400, 11, wave);
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count / 4; ++i) {
        points.x.push_back(points.x[i] + 1e-3);
        points.y.push_back(points.y[i]);
        points.z.push_back(points.z[i] - 5e-4);
        points.values.push_back(wave(points.x.back(), points.y.back(), points.z.back()));
    }
    const VolumeFit fit = fitVolume(points);
    constexpr double h = 1e-6;
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); i += 7) {
        const openvdb::Vec3d at(points.x[i] + 1e-4, points.y[i] - 2e-4, points.z[i]);
        const openvdb::Vec3d gradient = fit.volume.gradient(at);
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Vec3d step(0.0);
            step[axis] = h;
            const double expected =
                (fit.volume.value(at + step) - fit.volume.value(at - step)) / (2 * h);
            largest = std::max(largest, std::abs(gradient[axis] - expected));
        }
    }
    EXPECT_LE(largest, 2e-4);
    EXPECT_GT(largest, 0);

    constexpr double kVoxel = 0.02;
    ColumnGrid wanted{"slope", 0, 1, openvdb::VEC_COVARIANT};
    wanted.isGradient = true;
    const auto grids = splineVolumeToGrids(fit.volume, {{"value", 0}, wanted}, kVoxel);
    ASSERT_EQ(grids.size(), 2U);
    const auto slopes = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[1]);
    ASSERT_TRUE(slopes);
    EXPECT_EQ(slopes->getVectorType(), openvdb::VEC_COVARIANT);
    EXPECT_EQ(slopes->activeVoxelCount(), grids[0]->activeVoxelCount());
    int voxels = 0;
    for (auto i = slopes->cbeginValueOn(); i; ++i) {
        if (++voxels % 97 != 0) continue;
        const openvdb::Vec3d expected = fit.volume.gradient(slopes->indexToWorld(i.getCoord()));
        EXPECT_LE((openvdb::Vec3d(*i) - expected).length(), 1e-5 * (1 + expected.length()));
    }
    EXPECT_GT(voxels, 10000);
    wanted.columns = 3;
    EXPECT_EQ(errorKindOf([&] { splineVolumeToGrids(fit.volume, {wanted}, kVoxel); }),
              ErrorKind::Usage);
}

TEST(FitVolume, SmoothsNoise) {
    ScatteredPoints points = randomInCube(1500, 7, ball);
    std::mt19937 generator(1);
    constexpr double kNoise = 0.05;
    for (double& value : points.values) {
        double sum = -6;
        for (int k = 0; k < 12; ++k) sum += generator() / 4294967296.0;
        value += kNoise * sum;
    }
    FitVolumeOptions options;
    options.noise = kNoise;
    const VolumeFit fit = fitVolume(points, options);
    EXPECT_TRUE(fit.noiseReached);
    EXPECT_LE(rmsInside(fit.volume, ball), 0.4 * kNoise);
    options.noise = 100;
    EXPECT_FALSE(fitVolume(points, options).noiseReached);
}

TEST(FitVolume, HasControlPointsNearDataOnly) {
    // Two small clouds, a thousand times as far apart as they are wide.
    ScatteredPoints points = randomInCube(500, 4, wave);
    const ScatteredPoints other = randomInCube(500, 9, wave);
    for (std::size_t i = 0; i < other.size(); ++i) {
        points.x.push_back(other.x[i] + 1000);
        points.y.push_back(other.y[i] + 1000);
        points.z.push_back(other.z[i]);
        points.values.push_back(other.values[i]);
    }
    const VolumeFit fit = fitVolume(points);
    EXPECT_LE(largestLeft(fit.volume, points), 1e-11);
    EXPECT_LE(fit.volume.controlPoints(), 300000U);
    EXPECT_TRUE(fit.volume.covers({1000.5, 1000.5, 0.5}));
    EXPECT_FALSE(fit.volume.covers({500, 500, 0.5}));
    EXPECT_NEAR(fit.volume.value({1000.5, 1000.5, 0.5}), wave(0.5, 0.5, 0.5), 5e-3);
    EXPECT_NEAR(fit.volume.value({0.5, 0.5, 0.5}), wave(0.5, 0.5, 0.5), 5e-3);
}

TEST(FitVolume, TakesPlanesLinesAndPairs) {
    ScatteredPoints line;
    for (int i = 0; i < 20; ++i) {
        line.x.push_back(i);
        line.y.push_back(2);
        line.z.push_back(-1);
        line.values.push_back(std::sin(0.3 * i));
    }
    VolumeFit fit = fitVolume(line);
    EXPECT_LE(largestLeft(fit.volume, line), 4e-12);
    EXPECT_NEAR(fit.volume.value({7.5, 2, -1}), std::sin(0.3 * 7.5), 0.02);
    ScatteredPoints two;
    two.x = {0, 1};
    two.y = {0, 0};
    two.z = {0, 0};
    two.values = {3, 5};
    fit = fitVolume(two);
    EXPECT_LE(largestLeft(fit.volume, two), 1e-11);
    EXPECT_NEAR(fit.volume.value({0.5, 0, 0}), 4, 0.2);
    // A pair a millionth apart.
    ScatteredPoints pair = randomInCube(100, 6, wave);
    pair.x.push_back(pair.x[7] + 1e-5);
    pair.y.push_back(pair.y[7]);
    pair.z.push_back(pair.z[7]);
    pair.values.push_back(pair.values[7] + 1e-3);
    fit = fitVolume(pair);
    EXPECT_LE(fit.largest, 1e-9);
}

TEST(FitVolume, IsTheSameForAnyNumberOfThreads) {
    const ScatteredPoints points = randomInCube(3000, 8, wave);
    std::vector<float> first;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        const VolumeFit fit = fitVolume(points);
        const auto grids = splineVolumeToGrids(fit.volume, {{"wave", 0, 1}}, 0.03);
        std::vector<float> values;
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
        for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) values.push_back(*voxel);
        if (first.empty()) first = values;
        EXPECT_FALSE(values.empty());
        EXPECT_TRUE(values == first);
    }
}

TEST(FitVolume, RefusesWhatHasNoField) {
    const auto kindOf = [](const ScatteredPoints& points, const FitVolumeOptions& options = {}) {
        return errorKindOf([&] { fitVolume(points, options); });
    };
    ScatteredPoints one;
    one.x = {1};
    one.y = {1};
    one.z = {1};
    one.values = {1};
    EXPECT_EQ(kindOf(one), ErrorKind::Input);
    EXPECT_EQ(kindOf(ScatteredPoints{}), ErrorKind::Usage);
    ScatteredPoints points = randomInCube(50, 1, wave);
    points.values[3] = NAN;
    EXPECT_EQ(kindOf(points), ErrorKind::Input);
    points = randomInCube(50, 1, wave);
    points.x[4] = points.x[5];
    points.y[4] = points.y[5];
    points.z[4] = points.z[5];
    EXPECT_EQ(kindOf(points), ErrorKind::Input);
    points = randomInCube(50, 1, wave);
    FitVolumeOptions options;
    options.reach = 1000;
    EXPECT_EQ(kindOf(points, options), ErrorKind::Usage);
    options = {};
    options.maxLevel = 17;
    EXPECT_EQ(kindOf(points, options), ErrorKind::Usage);
}

TEST(SplineVolumeToGrids, HasTheFieldWithinReachAndNothingElse) {
    ScatteredPoints points = randomInCube(800, 11, wave);
    points.columns = 4;
    points.values.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        points.values.insert(points.values.end(),
                             {points.x[i], wave(points.x[i], 1, 0), points.y[i], 7.0});
    }
    FitVolumeOptions options;
    options.reach = 0.15;
    const VolumeFit fit = fitVolume(points, options);
    const auto grids = splineVolumeToGrids(
        fit.volume, {{"v", 1, 3, openvdb::VEC_CONTRAVARIANT_RELATIVE}, {"x", 0, 1}}, 0.05);
    const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[0]);
    const auto scalars = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[1]);
    ASSERT_TRUE(vectors && scalars);
    EXPECT_EQ(vectors->getName(), "v");
    EXPECT_EQ(vectors->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    EXPECT_EQ(scalars->background(), 0.0F);
    auto vectorsAt = vectors->getConstAccessor();
    auto scalarsAt = scalars->getConstAccessor();
    const auto distanceOf = [&](const openvdb::Vec3d& place) {
        double least = 1e9;
        for (std::size_t i = 0; i < points.size(); ++i) {
            least = std::min(
                least, (place - openvdb::Vec3d(points.x[i], points.y[i], points.z[i])).length());
        }
        return least;
    };
    for (int x = -6; x <= 26; ++x) {
        for (int y = -6; y <= 26; y += 2) {
            for (int z = -6; z <= 26; z += 2) {
                const openvdb::Coord voxel(x, y, z);
                const openvdb::Vec3d place = voxel.asVec3d() * 0.05;
                const double distance = distanceOf(place);
                if (std::abs(distance - 0.15) < 1e-9) continue;
                ASSERT_EQ(scalarsAt.isValueOn(voxel), distance < 0.15) << voxel;
                EXPECT_EQ(vectorsAt.isValueOn(voxel), distance < 0.15);
                if (distance > 0.15) continue;
                EXPECT_NEAR(scalarsAt.getValue(voxel), fit.volume.value(place, 0), 1e-6);
                EXPECT_NEAR(vectorsAt.getValue(voxel)[0], fit.volume.value(place, 1), 1e-6);
                EXPECT_NEAR(vectorsAt.getValue(voxel)[2], fit.volume.value(place, 3), 1e-6);
            }
        }
    }
    EXPECT_EQ(errorKindOf([&] {
                  splineVolumeToGrids(fit.volume, {{"v", 2, 3}}, 0.1);
              }),
              ErrorKind::Usage);
    EXPECT_EQ(errorKindOf([&] {
                  splineVolumeToGrids(fit.volume, {{"v", 0, 1}}, 0);
              }),
              ErrorKind::Usage);
    for (double& x : points.x) x += 5;
    const VolumeFit aside = fitVolume(points, options);
    EXPECT_EQ(errorKindOf([&] {
                  splineVolumeToGrids(aside.volume, {{"v", 0, 1}}, 20);
              }),
              ErrorKind::Result);
}

}  // namespace
}  // namespace bandvox

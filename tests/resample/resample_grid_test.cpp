#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/resample/resample_grid.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/math/Transform.h>
#include <openvdb/tools/Dense.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Mat4d;
using openvdb::Vec3d;
using openvdb::math::Transform;

Transform::Ptr latticeOf(const Mat4d& matrix) {
    return Transform::createLinearTransform(matrix);
}

Mat4d scaled(const Vec3d& factors, const Vec3d& shift = Vec3d(0.0)) {
    Mat4d matrix = Mat4d::identity();
    matrix.postScale(factors);
    matrix.postTranslate(shift);
    return matrix;
}

Mat4d turned(double factor) {
    Mat4d matrix = Mat4d::identity();
    matrix.postScale(Vec3d(factor));
    matrix.postRotate(openvdb::math::X_AXIS, 0.4);
    matrix.postRotate(openvdb::math::Z_AXIS, -0.7);
    matrix.postTranslate(Vec3d(0.3, -2.2, 1.9));
    return matrix;
}

// A wave on a cube of voxels, and 0 around it.
FloatGrid::Ptr waveGrid(const Vec3d& k, int half) {
    auto grid = FloatGrid::create(0.0F);
    openvdb::tools::Dense<float> dense(openvdb::CoordBBox(Coord(-half), Coord(half)));
    const auto turn = [&](int axis, int i) {
        return std::polar(1.0, 2 * std::numbers::pi * k[axis] * i);
    };
    for (int x = -half; x <= half; ++x) {
        for (int y = -half; y <= half; ++y) {
            const std::complex<double> row = std::polar(1.0, 0.3) * turn(0, x) * turn(1, y);
            for (int z = -half; z <= half; ++z) {
                dense.setValue(Coord(x, y, z), static_cast<float>((row * turn(2, z)).real()));
            }
        }
    }
    openvdb::tools::copyFromDense(dense, *grid, 0.0F);
    return grid;
}

struct LatticeCase {
    const char* name;
    Mat4d matrix;
    double margin;  // source voxels near the cube's faces that are left out
};

// Of a wave nothing is left but the wave, as much of it as the filter lets pass.
TEST(ResampleGrid, ScalesWavesByTheFilter) {
    constexpr int kHalf = 36;
    const LatticeCase cases[] = {
        {"as it is", scaled(Vec3d(1.0)), 12},
        {"shifted", scaled(Vec3d(1.0), Vec3d(0.37, -0.5, 2.9)), 22},
        {"halved", scaled(Vec3d(2.0)), 28},
        {"by 1.37", scaled(Vec3d(1.37), Vec3d(0.2, 0.4, 0.6)), 26},
        {"anisotropic", scaled(Vec3d(1.0, 2.2, 1.6)), 30},
        {"finer", scaled(Vec3d(0.6)), 20},
        {"turned", turned(1.8), 30},
        {"by 3.2, of two steps", scaled(Vec3d(3.2), Vec3d(1.0, 0.5, 0.25)), 31},
    };
    for (const LatticeCase& to : cases) {
        for (const ExponentialFilter& filter :
             {ExponentialFilter{2, 0.16}, ExponentialFilter{4, 0.2}}) {
            for (const Vec3d& k : {Vec3d(0.05, -0.04, 0.03), Vec3d(0.3, -0.21, 0.4)}) {
                SCOPED_TRACE(std::string(to.name) + ", order " + std::to_string(filter.order) +
                             ", k.x " + std::to_string(k.x()));
                const auto source = waveGrid(k, kHalf);
                ResampleOptions options;
                options.filter = filter;
                const auto target = latticeOf(to.matrix);
                const auto grid = resampleGrid(source, *target, options).grid;

                // |Aᵀk|, not less along finer axes: of these cases the matrices tell it at once.
                Vec3d rows(0.0);
                for (int i = 0; i < 3; ++i) {
                    const Vec3d row(to.matrix(i, 0), to.matrix(i, 1), to.matrix(i, 2));
                    rows[i] = row.dot(k) * std::max(1.0, 1 / row.length());
                }
                const double left = filter(rows.length());
                int checked = 0;
                double worst = 0;
                const double limit = kHalf - to.margin;
                auto accessor = grid->getConstAccessor();
                for (int x = -40; x <= 40; ++x) {
                    for (int y = -40; y <= 40; y += 3) {
                        for (int z = -39; z <= 40; z += 2) {
                            const Vec3d place = to.matrix.transform(Vec3d(x, y, z));
                            if (std::abs(place[0]) > limit || std::abs(place[1]) > limit ||
                                std::abs(place[2]) > limit) {
                                continue;
                            }
                            const double expected =
                                left * std::cos(2 * std::numbers::pi * k.dot(place) + 0.3);
                            worst = std::max(
                                worst, std::abs(accessor.getValue(Coord(x, y, z)) - expected));
                            ++checked;
                        }
                    }
                }
                ASSERT_GE(checked, 4);
                // A wave is not the half-space that the tolerance is meant for, and fills space.
                EXPECT_LE(worst, 3e-4);
            }
        }
    }
}

DensityResult densityOf(const char* shape, double voxelSize, const ExponentialFilter& filter = {}) {
    DensityOptions options;
    options.voxelSize = voxelSize;
    options.filter = filter;
    options.tolerance = 2e-5;
    return surfaceToDensity(*makeShapeBoundary(shape), options);
}

double largestDifference(const FloatGrid& a, const FloatGrid& b) {
    double largest = 0;
    auto ofA = a.getConstAccessor(), ofB = b.getConstAccessor();
    for (auto it = a.cbeginValueOn(); it; ++it) {
        if (it.isTileValue()) {
            for (auto voxel = it.getBoundingBox().begin(); voxel; ++voxel) {
                largest = std::max<double>(largest, std::abs(*it - ofB.getValue(*voxel)));
            }
        } else {
            largest = std::max<double>(largest, std::abs(*it - ofB.getValue(it.getCoord())));
        }
    }
    for (auto it = b.cbeginValueOn(); it; ++it) {
        if (it.isVoxelValue()) {
            largest = std::max<double>(largest, std::abs(*it - ofA.getValue(it.getCoord())));
        }
    }
    return largest;
}

// What convert makes of a shape on the coarser lattice at once.
TEST(ResampleGrid, MakesOfADensityWhatItsSourceWouldBecome) {
    for (const char* shape : {"shape:torus", "shape:cube"}) {
        const auto fine = densityOf(shape, 0.025);
        for (const double factor : {1.5, 2.0, 4.0, 7.0}) {
            SCOPED_TRACE(std::string(shape) + " by " + std::to_string(factor));
            const auto expected = densityOf(shape, 0.025 * factor);
            const auto target = uniformLattice(*fine.grid, 0.025 * factor);
            const auto result = resampleGrid(fine.grid, *target);
            EXPECT_LE(largestDifference(*result.grid, *expected.grid), 2e-4);
            EXPECT_NEAR(densityIntegral(*result.grid), fine.metadata.gridVolume,
                        1e-4 * fine.metadata.gridVolume);
            const auto metadata = densityMetadata(*result.grid);
            ASSERT_TRUE(metadata);
            EXPECT_EQ(metadata->order, 2);
            EXPECT_EQ(metadata->cutoff, 0.16);
            EXPECT_EQ(metadata->sourceVolume, fine.metadata.sourceVolume);
            EXPECT_NEAR(metadata->gridVolume, densityIntegral(*result.grid), 1e-9);
            EXPECT_EQ(result.grid->getName(), "density");
            EXPECT_EQ(result.steps, factor > 6 ? 3 : factor > 3 ? 2 : 1);
        }
    }
}

// Sharper than it was cannot become what the filter has taken, but nearly so where it has not.
TEST(ResampleGrid, SharpensWhatTheCoarserLatticeCanHold) {
    const auto fine = densityOf("shape:torus", 0.02);
    ResampleOptions options;
    options.filter = ExponentialFilter{4, 0.25};
    const auto expected = densityOf("shape:torus", 0.04, *options.filter);
    const auto result = resampleGrid(fine.grid, *uniformLattice(*fine.grid, 0.04), options);
    EXPECT_LE(largestDifference(*result.grid, *expected.grid), 3e-4);
}

TEST(ResampleGrid, OntoItsOwnLatticeChangesNothing) {
    const auto density = densityOf("shape:torus", 0.05);
    const auto result = resampleGrid(density.grid, density.grid->transform());
    EXPECT_LE(largestDifference(*result.grid, *density.grid), 5e-5);
}

TEST(ResampleGrid, KeepsTilesAndTheBackground) {
    auto grid = FloatGrid::create(-2.0F);
    grid->fill(openvdb::CoordBBox(Coord(-200), Coord(199)), 5.0F, true);
    grid->fill(openvdb::CoordBBox(Coord(400), Coord(650)), 3.0F, false);
    const auto result = resampleGrid(grid, *latticeOf(scaled(Vec3d(2.0))));
    EXPECT_EQ(result.grid->background(), -2);
    EXPECT_EQ(result.amplitude, 7);
    EXPECT_NEAR(result.maximum, 5, 1e-3);
    auto accessor = result.grid->getConstAccessor();
    EXPECT_EQ(accessor.getValue(Coord(20)), 5);
    EXPECT_TRUE(accessor.isValueOn(Coord(20)));
    EXPECT_EQ(accessor.getValue(Coord(260)), 3);
    EXPECT_FALSE(accessor.isValueOn(Coord(260)));
    EXPECT_EQ(accessor.getValue(Coord(-120)), -2);
    EXPECT_FALSE(accessor.isValueOn(Coord(-120)));
    // On the outermost voxel of the solid, the Gaussian's weights on its inner side.
    double inside = 0, all = 0;
    for (int n = -40; n <= 40; ++n) {
        const double weight = std::exp(-std::pow(std::numbers::pi * 0.08 * n, 2));
        all += weight;
        if (n >= 0) inside += weight;
    }
    EXPECT_NEAR(accessor.getValue(Coord(-100, 20, 20)), -2 + 7 * inside / all, 3e-4);
    // Inside, a tile of 128³ voxels, or what is left of one.
    EXPECT_LT(result.grid->tree().getValueDepth(Coord(16)), 3);
    EXPECT_LT(result.grid->tree().leafCount(), 15500U);
    EXPECT_GT(result.grid->tree().activeTileCount(), 0U);
}

TEST(ResampleGrid, IsTheSameForAnyNumberOfThreads) {
    const auto density = densityOf("shape:torus", 0.03);
    const auto target =
        latticeOf(density.grid->transform().baseMap()->getAffineMap()->getMat4() * turned(1.7));
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return resampleGrid(density.grid, *target).grid;
    };
    const auto one = run(1), four = run(4);
    EXPECT_TRUE(one->tree().hasSameTopology(four->tree()));
    EXPECT_EQ(largestDifference(*one, *four), 0);
}

TEST(ResampleGrid, ReadsBetweenNodesWithoutAFilter) {
    const auto density = densityOf("shape:torus", 0.05);
    ResampleOptions options;
    options.filter.reset();
    // Half a voxel aside and back.
    Mat4d half = scaled(Vec3d(1.0), Vec3d(0.5, 0.25, -0.5));
    const Mat4d matrix = density.grid->transform().baseMap()->getAffineMap()->getMat4();
    const auto aside = resampleGrid(density.grid, *latticeOf(half * matrix), options).grid;
    EXPECT_GT(largestDifference(*aside, *density.grid), 0.1);
    const auto back = resampleGrid(aside, density.grid->transform(), options).grid;
    EXPECT_LE(largestDifference(*back, *density.grid), 2e-4);
}

// What a lattice holds ends at its own cutoff along axes that became coarser, and where the
// source's did if all became finer.
TEST(ResampleGrid, SaysWhereTheSpectrumEnds) {
    const auto density = densityOf("shape:torus", 0.1);
    const auto cutoff = [&](const Vec3d& factors, bool filters) {
        const auto target = density.grid->transform().copy();
        target->preScale(factors);
        ResampleOptions options;
        if (!filters) options.filter.reset();
        return densityMetadata(*resampleGrid(density.grid, *target, options).grid)->cutoff;
    };
    EXPECT_NEAR(cutoff(Vec3d(0.5), true), 0.08, 1e-9);
    EXPECT_NEAR(cutoff(Vec3d(0.5, 1, 2), true), 0.16, 1e-9);
    EXPECT_NEAR(cutoff(Vec3d(0.5), false), 0.08, 1e-9);
    EXPECT_NEAR(cutoff(Vec3d(1, 1, 1.5), false), 0.24, 1e-9);
}

TEST(ResampleGrid, TakesAnEmptyGrid) {
    const auto result = resampleGrid(FloatGrid::create(3.0F), *latticeOf(scaled(Vec3d(2.0))));
    EXPECT_TRUE(result.grid->empty());
    EXPECT_EQ(result.grid->background(), 3);
}

TEST(ResampleGrid, RefusesWhatItCannotDo) {
    const auto kindOf = [](const FloatGrid::ConstPtr& grid, const Transform& target,
                           const ResampleOptions& options) {
        try {
            resampleGrid(grid, target, options);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << "nothing was thrown";
        return ErrorKind::Runtime;
    };
    auto grid = FloatGrid::create(0.0F);
    grid->tree().setValue(Coord(1, 2, 3), 1.0F);
    const auto target = latticeOf(scaled(Vec3d(2.0)));
    ResampleOptions options;
    EXPECT_EQ(kindOf(nullptr, *target, {}), ErrorKind::Usage);
    options.tolerance = 1;
    EXPECT_EQ(kindOf(grid, *target, options), ErrorKind::Usage);
    options = {};
    options.filter = ExponentialFilter{0.5, 0.2};
    EXPECT_EQ(kindOf(grid, *target, options), ErrorKind::Usage);
    const auto frustum =
        Transform::createFrustumTransform(openvdb::BBoxd(Vec3d(0.0), Vec3d(10.0)), 0.5, 2.0, 1.0);
    EXPECT_EQ(kindOf(grid, *frustum, {}), ErrorKind::Usage);
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        grid->tree().setValue(Coord(5), value);
        EXPECT_EQ(kindOf(grid, *target, {}), ErrorKind::Input);
    }
    EXPECT_THROW(uniformLattice(*grid, 0), Error);
}

}  // namespace
}  // namespace bandvox

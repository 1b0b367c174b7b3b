#include "bandlimit/spread_bricks.h"

#include "bandlimit/closed_form_density.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/progress.h>
#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

DensityOptions optionsOf(const ExponentialFilter& filter, double tolerance, int tile = 0) {
    DensityOptions options;
    options.filter = filter;
    options.tolerance = tolerance;
    options.voxelSize = 1;
    options.tile = tile;
    return options;
}

// About 25 triangles a square voxel.
MeshSource fineBall() {
    return {"ball", ballMesh(16, Vec3d(3.2, 101.7, -2.4), 6)};
}

// Tiles get from bricks what is spread for each of them alone, and know the same cells as near.
void expectSameTiles(const BoundarySource& source, const DensityOptions& options) {
    const TilePlan plan = makeTilePlan(options);
    const TileLayout layout = layOutTiles(source.bounds(), 1, plan);
    const TileFilter filter(plan);
    const SpreadBricks bricks(source, plan, layout, filter, {}, silentProgress());
    NearCells near(plan.halo, plan.interior), nearOfBricks(plan.halo, plan.interior);
    const FftBuffer buffer = filter.allocate(), ofBricks = filter.allocate();
    std::int64_t samplesOfAll = 0;
    for (int x = 0; x < layout.count.x(); ++x) {
        for (int y = 0; y < layout.count.y(); ++y) {
            for (int z = 0; z < layout.count.z(); ++z) {
                const Coord tile(x, y, z);
                const SamplingRegion region{
                    1, layout.tileOrigin(tile).asVec3d() + filter.regionOffset(), Vec3d(plan.side)};
                std::vector<SurfaceSample> samples;
                for (std::size_t e = 0; e < source.elementCount(); ++e) {
                    source.sampleElement(e, region, plan.quadrature, samples);
                }
                const SpreadBricks::Content content = bricks.contentOf(tile);
                ASSERT_EQ(content.samples, static_cast<std::int64_t>(samples.size()));
                samplesOfAll += content.samples;
                if (samples.empty()) continue;
                EXPECT_TRUE(bricks.isInColumn(y, z));

                near.mark(samples, -filter.regionOffset());
                bricks.mark(tile, Coord::round(-filter.regionOffset()), nearOfBricks);
                for (int i = 0; i < near.count(); ++i) {
                    for (int j = 0; j < near.count(); ++j) {
                        for (int k = 0; k < near.count(); ++k) {
                            ASSERT_EQ(near.isNear(i, j, k), nearOfBricks.isNear(i, j, k));
                        }
                    }
                }

                std::fill_n(buffer.get(), filter.bufferSize(), 0.0F);
                std::fill_n(ofBricks.get(), filter.bufferSize(), 0.0F);
                filter.spread(samples, buffer.get());
                bricks.addTo(tile, ofBricks.get());
                float largest = 0, difference = 0;
                for (std::size_t i = 0; i < filter.bufferSize(); ++i) {
                    largest = std::max(largest, std::abs(buffer.get()[i]));
                    difference =
                        std::max(difference, std::abs(buffer.get()[i] - ofBricks.get()[i]));
                }
                EXPECT_GT(largest, 0.01F);
                // Each sums thousands of small numbers in single precision, in its own order.
                EXPECT_LE(difference, 2e-5F * largest);
            }
        }
    }
    EXPECT_GT(samplesOfAll, static_cast<std::int64_t>(source.elementCount()));
}

TEST(SpreadBricks, GiveTilesWhatIsSpreadForEach) {
    const MeshSource source = fineBall();
    // Kernels narrow and wide, halos from a few voxels to more than half a tile.
    expectSameTiles(source, optionsOf({2, 0.16}, 1e-4));
    expectSameTiles(source, optionsOf({4, 0.28}, 1e-5));
    expectSameTiles(source, optionsOf({2.2, 0.18}, 1e-4));
    expectSameTiles(source, optionsOf({2, 0.16}, 1e-4, 32));
    expectSameTiles(source, optionsOf({2, 0.16}, 1e-4, 18));
}

TEST(SpreadBricks, ServeElementsThatReachFar) {
    // A few triangles much longer than a brick among nothing else.
    const MeshSource source("box", TurnedBox{Vec3d(40, 3, 22), Vec3d(0.3), someRotation()}.mesh(1));
    expectSameTiles(source, optionsOf({2, 0.16}, 1e-4));
}

TEST(SpreadBricks, AreUsedForManySmallElementsOnly) {
    const MeshSource source = fineBall();
    EXPECT_TRUE(SpreadBricks::payFor(source, 1));
    EXPECT_FALSE(SpreadBricks::payFor(source, 0.25));
}

TEST(SpreadBricks, OfWantedColumnsHaveWhatTheseNeed) {
    const MeshSource source = fineBall();
    const TilePlan plan = makeTilePlan(optionsOf({2, 0.16}, 1e-4, 32));
    const TileLayout layout = layOutTiles(source.bounds(), 1, plan);
    const TileFilter filter(plan);
    std::vector<bool> wanted(static_cast<std::size_t>(layout.count.y()) * layout.count.z());
    wanted[1] = true;
    ASSERT_GT(wanted.size(), 3U);
    const SpreadBricks all(source, plan, layout, filter, {}, silentProgress());
    const SpreadBricks some(source, plan, layout, filter, wanted, silentProgress());
    std::int64_t samples = 0, others = 0;
    for (int x = 0; x < layout.count.x(); ++x) {
        const Coord first(x, 0, 1), last(x, layout.count.y() - 1, layout.count.z() - 1);
        EXPECT_EQ(some.contentOf(first).samples, all.contentOf(first).samples);
        samples += some.contentOf(first).samples;
        others += all.contentOf(last).samples - some.contentOf(last).samples;
    }
    EXPECT_GT(samples, 0);
    EXPECT_GT(others, 0);
}

// As SurfaceToDensity's tests of the same name, which are of larger elements.
TEST(SpreadBricks, ThreadsDoNotChangeABitAndTheOrderOfTrianglesOnlyRounding) {
    Mesh mesh = ballMesh(16, Vec3d(3.2, 1.7, -2.4), 6);
    openvdb::FloatGrid::Ptr grids[3];
    for (int threads = 1; threads <= 2; ++threads) {
        const ThreadLimit limit(threads);
        grids[threads - 1] =
            surfaceToDensity(MeshSource("ball", mesh), optionsOf({2, 0.16}, 1e-4)).grid;
    }
    std::mt19937 random(1);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    grids[2] = surfaceToDensity(MeshSource("ball", mesh), optionsOf({2, 0.16}, 1e-4)).grid;
    ASSERT_TRUE(grids[0]->tree().hasSameTopology(grids[1]->tree()));
    double largest = 0;
    for (auto value = grids[0]->cbeginValueOn(); value; ++value) {
        ASSERT_EQ(*value, grids[1]->tree().getValue(value.getCoord()));
        const float shuffled = grids[2]->tree().getValue(value.getCoord());
        // What is near 0 or 1 may have been stored as that, or not.
        if (shuffled == 0 || shuffled == 1 || *value == 1) continue;
        largest = std::max<double>(largest, std::abs(*value - shuffled));
    }
    EXPECT_GT(grids[0]->activeVoxelCount(), 10000U);
    EXPECT_LE(largest, 2e-6);
}

// Triangles down to a hundredth of a voxel, so that a brick has far more samples than are summed
// up at once.
TEST(SpreadBricks, OfMillionsOfSamplesStayAccurate) {
    const Vec3d center(0.21, -0.37, 0.11);
    const ExponentialFilter filter{2, 0.16};
    const ClosedFormDensity truth(64, filter, ballTransform(5, center));
    const DensityResult result =
        surfaceToDensity(MeshSource("ball", ballMesh(5, center, 8)), optionsOf(filter, 1e-5));
    EXPECT_LE(truth.largestError(*result.grid), 1e-4);
    EXPECT_LE(result.metadata.closureError, 1e-4);
}

}  // namespace
}  // namespace bandvox

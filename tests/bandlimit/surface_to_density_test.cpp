#include "bandlimit/closed_form_density.h"
#include "source/test_meshes.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

const ExponentialFilter kFilters[] = {{2, 0.16}, {4, 0.2}, {4, 0.28}, {8, 0.35}};

DensityOptions optionsFor(const ExponentialFilter& filter, double voxelSize) {
    DensityOptions options;
    options.filter = filter;
    options.voxelSize = voxelSize;
    return options;
}

TurnedBox boxOf(const Vec3d& half) {
    return {half, Vec3d(0.31, -0.17, 0.43), someRotation()};
}

// Voxels where two grids differ by more than `tolerance`, in value or in being active.
int countDifferences(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b, double tolerance,
                     const Coord& shift = Coord(0)) {
    int differences = 0;
    const auto compare = [&](const openvdb::FloatGrid& from, const openvdb::FloatGrid& to,
                             const Coord& offset) {
        const openvdb::FloatGrid::ConstAccessor accessor = to.getConstAccessor();
        openvdb::CoordBBox box = from.evalActiveVoxelBoundingBox();
        for (auto voxel = box.begin(); voxel; ++voxel) {
            const float value = from.tree().getValue(*voxel);
            const float other = accessor.getValue(*voxel + offset);
            const bool isSame = tolerance == 0
                                    ? value == other && from.tree().isValueOn(*voxel) ==
                                                            accessor.isValueOn(*voxel + offset)
                                    : std::abs(value - other) <= tolerance;
            if (!isSame) ++differences;
        }
    };
    compare(a, b, shift);
    compare(b, a, -shift);
    return differences;
}

// --- the closed forms ---------------------------------------------------------------------------

// Sides of 64 and 200 voxels: one tile and many, and a lattice that is no power of two.
TEST(SurfaceToDensity, TurnedBoxesEqualTheirTransforms) {
    for (const Vec3d& half : {Vec3d(1, 1, 1), Vec3d(61, 52, 33)}) {
        for (const int resolution : {64, 200}) {
            // Scale the box so that the longest side of its bounds is N voxels.
            TurnedBox box = boxOf(half);
            const Vec3d size = MeshSource("box", box.mesh(1)).bounds().extents();
            box.half *= resolution / std::max({size.x(), size.y(), size.z()});
            const MeshSource source("box", box.mesh(0.01));
            for (const ExponentialFilter& filter : kFilters) {
                DensityOptions options = optionsFor(filter, 0);
                options.resolution = resolution;
                const DensityResult result = surfaceToDensity(source, options);
                EXPECT_NEAR(result.grid->voxelSize().x(), 0.01, 1e-12);
                const ClosedFormDensity truth(resolution == 64 ? 128 : 240, filter,
                                              box.transform());
                EXPECT_LE(truth.largestError(*result.grid), 1e-4)
                    << half << " " << resolution << " " << filter.order << " " << filter.cutoff;
            }
        }
    }
}

TEST(SurfaceToDensity, FineBallsEqualTheBallsTransform) {
    const Vec3d center(0.21, -0.37, 0.11);
    for (const double radius : {32.0, 100.0}) {
        const MeshSource source("ball", ballMesh(radius, center, radius < 50 ? 7 : 8));
        for (const ExponentialFilter& filter : kFilters) {
            const ClosedFormDensity truth(radius < 50 ? 128 : 240, filter,
                                          ballTransform(radius, center));
            const DensityResult result = surfaceToDensity(source, optionsFor(filter, 1));
            EXPECT_LE(truth.largestError(*result.grid), 1e-4)
                << radius << " " << filter.order << " " << filter.cutoff;
        }
    }
}

TEST(SurfaceToDensity, TurnedBoxEqualsItsTransformForEveryTile) {
    const TurnedBox box = boxOf(Vec3d(22.1, 13.7, 7.9));
    const MeshSource source("box", box.mesh(1));
    for (const ExponentialFilter& filter : kFilters) {
        const ClosedFormDensity truth(128, filter, box.transform());
        for (const int tile : {32, 64, 96, 74}) {
            DensityOptions options = optionsFor(filter, 1);
            options.tile = tile;
            const DensityResult result = surfaceToDensity(source, options);
            EXPECT_EQ(result.tileSide, tile);
            EXPECT_LE(truth.largestError(*result.grid), 1e-4)
                << filter.order << " " << filter.cutoff << " tile " << tile;
        }
    }
}

// Curved patches are integrated as they are, without a mesh between.
TEST(SurfaceToDensity, ShapeEqualsTheBallsTransform) {
    const std::unique_ptr<BoundarySource> source = makeShapeBoundary("shape:sphere");
    for (const ExponentialFilter& filter : kFilters) {
        const ClosedFormDensity truth(128, filter, ballTransform(26.7, Vec3d(0)));
        const DensityResult result = surfaceToDensity(*source, optionsFor(filter, 1 / 26.7));
        EXPECT_LE(truth.largestError(*result.grid), 1e-4) << filter.order << " " << filter.cutoff;
    }
}

TEST(SurfaceToDensity, TighterToleranceMeansLessError) {
    const TurnedBox box = boxOf(Vec3d(22.1, 13.7, 7.9));
    const MeshSource source("box", box.mesh(1));
    const ExponentialFilter filter{4, 0.2};
    const ClosedFormDensity truth(128, filter, box.transform());
    double last = 1;
    for (const double tolerance : {3e-2, 3e-3, 3e-4, 3e-5, 5e-6}) {
        DensityOptions options = optionsFor(filter, 1);
        options.tolerance = tolerance;
        const DensityResult result = surfaceToDensity(source, options);
        const double error = truth.largestError(*result.grid);
        EXPECT_LE(error, tolerance);
        EXPECT_LT(error, last / 2) << tolerance;
        EXPECT_LE(result.metadata.closureError, tolerance);
        last = error;
    }
}

// --- exact properties ---------------------------------------------------------------------------

TEST(SurfaceToDensity, TilesDoNotShow) {
    const MeshSource source("ball", ballMesh(40, Vec3d(3.2, 1.7, -2.4), 5));
    DensityOptions options = optionsFor({4, 0.25}, 1);
    options.tile = 64;
    const DensityResult reference = surfaceToDensity(source, options);
    for (const int tile : {32, 96}) {
        options.tile = tile;
        const DensityResult result = surfaceToDensity(source, options);
        EXPECT_EQ(countDifferences(*reference.grid, *result.grid, options.tolerance), 0) << tile;
    }
}

TEST(SurfaceToDensity, ThreadsDoNotChangeABit) {
    const MeshSource source("ball", ballMesh(60, Vec3d(3.2, 1.7, -2.4), 5));
    openvdb::FloatGrid::Ptr grids[2];
    for (int threads = 1; threads <= 2; ++threads) {
        const ThreadLimit limit(threads);
        grids[threads - 1] = surfaceToDensity(source, optionsFor({2, 0.16}, 1)).grid;
    }
    EXPECT_TRUE(grids[0]->tree().hasSameTopology(grids[1]->tree()));
    EXPECT_EQ(countDifferences(*grids[0], *grids[1], 0), 0);
}

// Corners on multiples of 2^-10 and voxels of 2^-3, so that the shift itself is exact.
TEST(SurfaceToDensity, WholeVoxelShiftShiftsEveryBit) {
    constexpr double kVoxel = 0.125;
    Mesh mesh = boxOf(Vec3d(30.2, 21.7, 26.9)).mesh(kVoxel);
    for (Vec3d& point : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) point[axis] = std::round(point[axis] * 1024) / 1024;
    }
    const DensityResult reference =
        surfaceToDensity(MeshSource("box", mesh), optionsFor({2, 0.16}, kVoxel));
    for (const Coord shift : {Coord(1, 0, 0), Coord(3, -5, 7), Coord(-8, 129, -1001)}) {
        Mesh moved = mesh;
        for (Vec3d& point : moved.points) point += shift.asVec3d() * kVoxel;
        const DensityResult result =
            surfaceToDensity(MeshSource("box", moved), optionsFor({2, 0.16}, kVoxel));
        EXPECT_EQ(countDifferences(*reference.grid, *result.grid, 0, shift), 0) << shift;
    }
}

Mesh operator+(Mesh a, const Mesh& b) {
    test::append(a, b);
    return a;
}

TEST(SurfaceToDensity, IntegralIsTheVolume) {
    const Mesh ball = ballMesh(20, Vec3d(0.3), 4);
    const Mesh cavity = test::reversed(ballMesh(11, Vec3d(2.1, 0.3, -0.8), 3));
    const Mesh box = boxOf(Vec3d(9, 14, 5)).mesh(1);
    Mesh farBox = box;
    for (Vec3d& point : farBox.points) point += Vec3d(44, 3, -7);
    const struct {
        const char* name;
        Mesh mesh;
        double volume;
    } cases[] = {
        {"ball", ball, MeshSource("", ball).volume()},
        {"cavity", ball + cavity, MeshSource("", ball + cavity).volume()},
        {"two pieces", ball + farBox, MeshSource("", ball).volume() + 8 * 9 * 14 * 5},
        {"inside out", test::reversed(ball + cavity), MeshSource("", ball + cavity).volume()},
        {"one piece inside out", ball + test::reversed(farBox),
         MeshSource("", ball).volume() + 8 * 9 * 14 * 5},
    };
    for (const auto& [name, mesh, volume] : cases) {
        const MeshSource source(name, closeMesh(mesh).mesh);
        for (const ExponentialFilter& filter : kFilters) {
            const DensityResult result = surfaceToDensity(source, optionsFor(filter, 1));
            EXPECT_NEAR(result.metadata.gridVolume / volume, 1, 1e-4) << name << filter.order;
            EXPECT_NEAR(result.metadata.sourceVolume / volume, 1, 1e-12) << name;
        }
    }
}

// --- what the grid is like ----------------------------------------------------------------------

TEST(SurfaceToDensity, GridFollowsTheConventions) {
    const MeshSource source("ball", ballMesh(100, Vec3d(0), 5));
    const DensityResult result = surfaceToDensity(source, optionsFor({2, 0.16}, 1));
    const openvdb::FloatGrid& grid = *result.grid;
    EXPECT_EQ(grid.getName(), "density");
    EXPECT_EQ(grid.getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(grid.background(), 0);
    EXPECT_EQ(grid.tree().getValue(Coord(0)), 1);
    EXPECT_TRUE(grid.tree().isValueOn(Coord(0)));
    EXPECT_GT(grid.tree().activeTileCount(), 100U);
    // The volume of the leaves is that of the skin, not of the ball.
    EXPECT_LT(grid.tree().leafCount() * 512.0, 0.7 * result.metadata.sourceVolume);
    // What is not active is exactly the background.
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        for (auto value = leaf->cbeginValueOff(); value; ++value) EXPECT_EQ(*value, 0);
    }
    EXPECT_GE(result.minimum, -1e-3);
    EXPECT_LE(result.maximum, 1 + 1e-3);
    // One half lies on the surface.
    const float onSurface = grid.tree().getValue(Coord(100, 0, 0));
    EXPECT_NEAR(onSurface, 0.5, 0.02);
}

TEST(SurfaceToDensity, MetadataIsStoredInTheGrid) {
    const MeshSource source("ball.obj", ballMesh(10, Vec3d(0), 2));
    DensityOptions options = optionsFor({4, 0.2}, 1);
    options.iso = 0.4;
    const DensityResult result = surfaceToDensity(source, options);
    const std::optional<DensityMetadata> metadata = densityMetadata(*result.grid);
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->source, "ball.obj");
    EXPECT_EQ(metadata->route, "exact");
    EXPECT_EQ(metadata->order, 4);
    EXPECT_EQ(metadata->cutoff, 0.2);
    EXPECT_EQ(metadata->iso, 0.4);
    EXPECT_EQ(metadata->tolerance, 1e-4);
    EXPECT_GT(metadata->closureError, 0);
    EXPECT_LE(metadata->closureError, 1e-4);
    EXPECT_FALSE(metadata->clamped);
}

TEST(SurfaceToDensity, ClampCutsRinging) {
    const MeshSource source("ball", ballMesh(20, Vec3d(0), 4));
    DensityOptions options = optionsFor({8, 0.35}, 1);
    EXPECT_GT(surfaceToDensity(source, options).grid->tree().getValue(Coord(0, 18, 0)), 1.01F);
    options.clamp = true;
    const DensityResult result = surfaceToDensity(source, options);
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        ASSERT_GE(*value, 0);
        ASSERT_LE(*value, 1);
    }
    EXPECT_TRUE(result.metadata.clamped);
}

TEST(SurfaceToDensity, FilterThatTheLatticeCannotHoldIsAWarning) {
    const MeshSource source("ball", ballMesh(10, Vec3d(0), 4));
    const DensityResult result = surfaceToDensity(source, optionsFor({2, 0.2}, 1));
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_NE(result.warnings[0].find("0.00193"), std::string::npos) << result.warnings[0];
}

// A solid thinner than a voxel is faint, not lost.
TEST(SurfaceToDensity, ThinSheetKeepsItsVolume) {
    const MeshSource source("sheet", boxOf(Vec3d(20, 20, 0.05)).mesh(1));
    const DensityResult result = surfaceToDensity(source, optionsFor({2, 0.16}, 1));
    // Values below the tolerance are not stored, and there the whole solid is faint.
    EXPECT_NEAR(result.metadata.gridVolume / source.volume(), 1, 0.01);
}

// --- what is refused ----------------------------------------------------------------------------

ErrorKind kindOfError(const BoundarySource& source, const DensityOptions& options) {
    try {
        surfaceToDensity(source, options);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorKind::Runtime;
}

TEST(SurfaceToDensity, RefusesOptionsOutOfRange) {
    const MeshSource source("ball", ballMesh(10, Vec3d(0), 2));
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    DensityOptions options;
    for (const int resolution : {0, -1, 1 << 30}) {
        options.resolution = resolution;
        EXPECT_EQ(kindOfError(source, options), ErrorKind::Usage) << resolution;
    }
    for (const double voxelSize : {-1.0, kNaN, HUGE_VAL}) {
        options = DensityOptions{};
        options.voxelSize = voxelSize;
        EXPECT_EQ(kindOfError(source, options), ErrorKind::Usage) << voxelSize;
    }
    for (const double tolerance : {0.0, -1e-4, 1e-7, 0.5, kNaN}) {
        options = DensityOptions{};
        options.tolerance = tolerance;
        EXPECT_EQ(kindOfError(source, options), ErrorKind::Usage) << tolerance;
    }
    for (const double iso : {0.0, 1.0, -0.5, kNaN}) {
        options = DensityOptions{};
        options.iso = iso;
        EXPECT_EQ(kindOfError(source, options), ErrorKind::Usage) << iso;
    }
    for (const int tile : {-2, 8, 33, 1000}) {
        options = DensityOptions{};
        options.tile = tile;
        EXPECT_EQ(kindOfError(source, options), ErrorKind::Usage) << tile;
    }
}

TEST(SurfaceToDensity, RefusesWhatDoesNotFitInMemory) {
    const MeshSource source("ball", ballMesh(10, Vec3d(0), 2));
    EXPECT_EQ(kindOfError(source, optionsFor({2, 0.16}, 1e-4)), ErrorKind::Memory);
}

TEST(SurfaceToDensity, RefusesIndicesOutOfRange) {
    const MeshSource source("ball", ballMesh(10, Vec3d(1e12, 0, 0), 2));
    EXPECT_EQ(kindOfError(source, optionsFor({2, 0.16}, 1)), ErrorKind::Usage);
}

TEST(SurfaceToDensity, RefusesASurfaceThatIsNotClosed) {
    Mesh mesh = ballMesh(20, Vec3d(0), 3);
    mesh.triangles.erase(mesh.triangles.begin() + 7);
    EXPECT_EQ(kindOfError(MeshSource("open", mesh), optionsFor({2, 0.16}, 1)), ErrorKind::Result);
}

TEST(SurfaceToDensity, StopsWhenInterrupted) {
    class Impatient : public Progress {
      public:
        bool interrupted() const override { return true; }
    } impatient;
    const MeshSource source("ball", ballMesh(10, Vec3d(0), 2));
    try {
        surfaceToDensity(source, {}, impatient);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

}  // namespace
}  // namespace bandvox

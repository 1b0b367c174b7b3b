#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/iso_of_volume.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <string>

namespace bandvox {
namespace {

DensityResult shapeOf(const std::string& name, int resolution) {
    DensityOptions options;
    options.resolution = resolution;
    DensityResult result = surfaceToDensity(*makeShapeBoundary("shape:" + name), options);
    setDensityMetadata(*result.grid, result.metadata);
    return result;
}

double enclosedAt(const openvdb::FloatGrid::ConstPtr& grid, double iso) {
    MeshOptions options;
    options.iso = iso;
    return densityToMesh(grid, options).volume;
}

TEST(IsoOfVolume, EnclosesWhatTheSourceDoes) {
    for (const char* shape : {"sphere", "torus", "cube"}) {
        for (const int resolution : {8, 20}) {
            const DensityResult result = shapeOf(shape, resolution);
            const double volume = result.metadata.sourceVolume;
            const VolumeIso found = isoOfVolume(result.grid, volume);
            EXPECT_NEAR(found.volume, volume, 1e-5 * volume);
            EXPECT_DOUBLE_EQ(enclosedAt(result.grid, found.iso), found.volume);
            // Round shapes shrink at 0.5, the more the fewer voxels they have.
            EXPECT_GT(found.iso, 0.2);
            EXPECT_LT(found.iso, 0.5 + 1e-3) << shape << resolution;
        }
    }
}

TEST(IsoOfVolume, FindsVolumesOnBothSidesOfTheMiddle) {
    const auto grid = shapeOf("sphere", 24).grid;
    for (const double iso : {0.02, 0.2, 0.5, 0.7, 0.98}) {
        const double volume = enclosedAt(grid, iso);
        EXPECT_NEAR(isoOfVolume(grid, volume).iso, iso, 1e-4);
    }
}

ErrorKind kindOf(const openvdb::FloatGrid::ConstPtr& grid, double volume) {
    try {
        isoOfVolume(grid, volume);
    } catch (const Error& error) {
        return error.kind();
    }
    return ErrorKind::Runtime;
}

TEST(IsoOfVolume, RefusesWhatCannotBe) {
    const auto grid = shapeOf("sphere", 16).grid;
    EXPECT_EQ(kindOf(grid, 1e3), ErrorKind::Result);
    EXPECT_EQ(kindOf(grid, 1e-9), ErrorKind::Result);
    EXPECT_EQ(kindOf(grid, 0), ErrorKind::Usage);
    EXPECT_EQ(kindOf(nullptr, 1), ErrorKind::Usage);
    const auto levelSet =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0F, openvdb::Vec3f(0), 0.1F);
    EXPECT_EQ(kindOf(levelSet, 1), ErrorKind::Input);
}

TEST(IsoOfVolume, SaysSoWhereNoValueEnclosesIt) {
    // Two cubes of one value each: what is between their volumes is enclosed by none.
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->denseFill(openvdb::CoordBBox(0, 0, 0, 9, 9, 9), 1.0F);
    grid->denseFill(openvdb::CoordBBox(40, 0, 0, 49, 9, 9), 0.5F);
    const double one = enclosedAt(grid, 0.6), both = enclosedAt(grid, 0.4);
    EXPECT_EQ(kindOf(grid, 0.5 * (one + both)), ErrorKind::Result);
    EXPECT_NEAR(isoOfVolume(grid, one).volume, one, 1e-5 * one);
}

}  // namespace
}  // namespace bandvox

#include <bandvox/core/error.h>
#include <bandvox/resample/cubic_lattice.h>

#include <gtest/gtest.h>

namespace {

using openvdb::Mat4d;
using openvdb::math::Transform;

openvdb::FloatGrid::Ptr gridWith(const Mat4d& rows) {
    auto grid = openvdb::FloatGrid::create();
    grid->setTransform(Transform::createLinearTransform(rows));
    return grid;
}

// Turned, sheared, and of different sides.
Mat4d shearedLattice() {
    Mat4d rows = Mat4d::identity();
    rows.postScale(openvdb::Vec3d(0.1, 0.2, 0.3));
    rows.postShear(openvdb::math::X_AXIS, openvdb::math::Y_AXIS, 0.4);
    rows.postRotate(openvdb::math::Z_AXIS, 0.7);
    rows.postTranslate(openvdb::Vec3d(1, -2, 3));
    return rows;
}

TEST(CubicLattice, KnowsCubes) {
    EXPECT_TRUE(bandvox::hasCubicVoxels(*Transform::createLinearTransform(0.3)));
    Mat4d turned = Mat4d::identity();
    turned.postScale(openvdb::Vec3d(0.5));
    turned.postRotate(openvdb::math::Y_AXIS, 1.1);
    EXPECT_TRUE(bandvox::hasCubicVoxels(*Transform::createLinearTransform(turned)));
    EXPECT_FALSE(bandvox::hasCubicVoxels(*Transform::createLinearTransform(shearedLattice())));
    EXPECT_FALSE(bandvox::hasCubicVoxels(
        *Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 2)));
}

TEST(CubicLattice, IsOfCubesAlongTheGrid) {
    const auto grid = gridWith(shearedLattice());
    const auto lattice = bandvox::cubicLattice(*grid, 0.25);
    EXPECT_TRUE(bandvox::hasCubicVoxels(*lattice));
    EXPECT_NEAR(lattice->voxelSize()[0], 0.25, 1e-12);
    // Voxel 0 stays where it was, and so does the direction of the first axis.
    const openvdb::Vec3d origin = lattice->indexToWorld(openvdb::Vec3d(0, 0, 0));
    EXPECT_TRUE(origin.eq(openvdb::Vec3d(1, -2, 3), 1e-12));
    const openvdb::Vec3d first = lattice->indexToWorld(openvdb::Vec3d(1, 0, 0)) - origin;
    const openvdb::Vec3d before =
        grid->indexToWorld(openvdb::Vec3d(1, 0, 0)) - grid->indexToWorld(openvdb::Vec3d(0, 0, 0));
    EXPECT_NEAR(first.unit().dot(before.unit()), 1, 1e-12);
    EXPECT_THROW(bandvox::cubicLattice(*grid, 0), bandvox::Error);
}

}  // namespace

#include <bandvox/grid/same_lattice.h>

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::math::Transform;

Transform::Ptr turned(double voxel, double degrees, const Vec3d& shift) {
    auto transform = Transform::createLinearTransform(voxel);
    transform->postRotate(degrees * openvdb::math::pi<double>() / 180, openvdb::math::Z_AXIS);
    transform->preTranslate(shift);
    return transform;
}

TEST(SameLattice, CountsWholeVoxels) {
    for (const double degrees : {0.0, 31.0}) {
        const auto first = turned(0.3, degrees, Vec3d(0.25, 7, 0));
        for (const Coord& offset : {Coord(0), Coord(5, -7, 1000003)}) {
            auto other = first->copy();
            other->preTranslate(offset.asVec3d());
            const auto found = wholeVoxelOffset(*first, *other);
            ASSERT_TRUE(found);
            // The same place is a voxel that comes so much earlier in what was moved on.
            EXPECT_EQ(*found, -offset);
            EXPECT_NEAR(
                (first->indexToWorld(Coord(1, 2, 3)) - other->indexToWorld(Coord(1, 2, 3) + *found))
                    .length(),
                0, 1e-9);
            EXPECT_EQ(latticeDifference(*first, *other), "");
        }
    }
}

TEST(SameLattice, AllowsAMillionth) {
    const auto first = turned(1, 0, Vec3d(0));
    EXPECT_TRUE(wholeVoxelOffset(*first, *turned(1 + 5e-7, 0, Vec3d(0))));
    EXPECT_FALSE(wholeVoxelOffset(*first, *turned(1 + 5e-6, 0, Vec3d(0))));
    EXPECT_TRUE(wholeVoxelOffset(*first, *turned(1, 0, Vec3d(3 + 5e-7, 0, 0))));
    EXPECT_FALSE(wholeVoxelOffset(*first, *turned(1, 0, Vec3d(3 + 5e-5, 0, 0))));
}

TEST(SameLattice, SaysWhatDiffers) {
    const auto first = turned(1, 0, Vec3d(0));
    const auto says = [&](const Transform& other, const std::string& words) {
        EXPECT_FALSE(wholeVoxelOffset(*first, other));
        EXPECT_NE(latticeDifference(*first, other).find(words), std::string::npos)
            << latticeDifference(*first, other);
    };
    says(*turned(2, 0, Vec3d(0)), "(2, 2, 2)");
    says(*turned(1, 30, Vec3d(0)), "30 degrees");
    says(*turned(1, 0, Vec3d(0.5, 0, 0)), "-0.5");
    says(*Transform::createFrustumTransform(openvdb::BBoxd(Vec3d(0), Vec3d(10)), 0.5, 10),
         "linear");
}

}  // namespace
}  // namespace bandvox

#include "source/soup_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/winding_number.h>
#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/soup_to_voxels.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// In how many voxels two grids differ.
std::int64_t differences(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    std::int64_t count = 0;
    openvdb::CoordBBox box = a.evalActiveVoxelBoundingBox();
    box.expand(b.evalActiveVoxelBoundingBox());
    const auto inA = a.getConstAccessor();
    const auto inB = b.getConstAccessor();
    for (auto voxel = box.begin(); voxel; ++voxel) {
        if (inA.getValue(*voxel) != inB.getValue(*voxel)) ++count;
    }
    return count;
}

TEST(SoupToVoxels, OfClosedMeshesAreThoseOfTheScan) {
    Mesh hollow = test::askew(test::cube(Vec3d(-1.0), 2));
    test::append(hollow, test::reversed(test::askew(test::cube(Vec3d(-0.6), 1.2))));
    const auto expectSame = [](const Mesh& mesh, VoxelOptions options) {
        const VoxelResult scan = meshToVoxels(MeshSource("mesh", mesh), options);
        const VoxelResult soup = soupToVoxels({"soup", mesh, {}}, options);
        EXPECT_EQ(differences(*scan.grid, *soup.grid), 0) << options.voxelSize;
        EXPECT_EQ(scan.voxels, soup.voxels);
        options.axis = ScanAxis::Z;
        EXPECT_EQ(soupToVoxels({"soup", mesh, {}}, options).voxels, soup.voxels);
    };
    for (const Mesh& mesh : {test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 20, 30), hollow}) {
        expectSame(mesh, {.voxelSize = 0.1237});
        expectSame(mesh, {.voxelSize = 0.0311});
        expectSame(mesh, {.voxelSize = 0.0617, .threshold = 3});
        expectSame(mesh, {.voxelSize = 0.1237, .fraction = true});
    }
    // Faces, edges and corners on centres and on sub-samples.
    for (const double shift : {0.0, 0.0625, 0.03125}) {
        expectSame(test::cube(Vec3d(shift - 1), 2), {.voxelSize = 0.125});
        expectSame(test::cube(Vec3d(shift - 1), 2), {.voxelSize = 0.125, .threshold = 5});
    }
}

TEST(SoupToVoxels, FollowTheWindingNumber) {
    for (const Mesh& mesh : {test::askew(test::panels(0.1)), test::panels(0.2),
                             test::shredded(test::sphere(Vec3d(0.0), 1, 20, 30), 0.2)}) {
        const VoxelResult voxels = soupToVoxels({"soup", mesh, {}}, {.voxelSize = 0.11});
        const WindingNumber winding(mesh);
        const auto values = voxels.grid->getConstAccessor();
        openvdb::CoordBBox box = voxels.grid->evalActiveVoxelBoundingBox();
        box.expand(2);
        int asked = 0, wrong = 0;
        for (auto voxel = box.begin(); voxel; ++voxel) {
            const double exact = winding.exactAt(0.11 * (*voxel).asVec3d());
            if (std::abs(exact - 0.51) < 0.03) continue;
            ++asked;
            if (values.getValue(*voxel) != (exact > 0.51 ? 1 : 0)) ++wrong;
        }
        EXPECT_GT(asked, 3000);
        // Near openings as small as a few voxels a row may miss how the winding number comes and
        // goes.
        EXPECT_LE(wrong, asked / 300) << asked;
    }
}

TEST(SoupToVoxels, UniteTheSoupWithASolid) {
    const Mesh solid = test::cube(Vec3d(0.01), 2);
    const VoxelResult both =
        soupToVoxels({"both", test::panels(0.001), solid}, {.voxelSize = 0.0513});
    EXPECT_NEAR(both.volume, 15, 0.3);
    Mesh sheet = test::panels(0.1);
    sheet.triangles.resize(2);
    try {
        soupToVoxels({"sheet", sheet, {}}, {.voxelSize = 0.1});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Result);
    }
}

}  // namespace
}  // namespace bandvox

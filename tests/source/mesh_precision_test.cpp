// Coordinates as files have them: far from the origin, and hardly above 0.

#include "source/mesh_files.h"
#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_mesh.h>

#include <gtest/gtest.h>

#include <string>

namespace bandvox {
namespace {

using openvdb::Vec3d;

MeshFile readCubeAt(double offset, const test::TemporaryFolder& folder) {
    return readMesh(folder.write("a.obj", test::objText(test::cube(Vec3d(offset, 0, 0), 2.0))));
}

TEST(MeshPrecision, CoordinatesFarFromTheOriginAreSaidOrRefused) {
    const test::TemporaryFolder folder;
    EXPECT_TRUE(readCubeAt(10, folder).warnings.empty());
    const MeshFile coarse = readCubeAt(1000, folder);
    ASSERT_EQ(coarse.warnings.size(), 1U);
    EXPECT_NE(coarse.warnings[0].find("single precision"), std::string::npos);
    try {
        readCubeAt(1e6, folder);
        FAIL() << "a cube of side 2 was read to a tenth of a unit";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(error.what()).find("1e+06"), std::string::npos) << error.what();
    }
}

TEST(MeshPrecision, NumbersTooSmallForADoubleAreZero) {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::string& number) {
        return readMesh(folder.write("a.obj", "v " + number + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    };
    for (const char* small : {"1e-400", "1E-400"}) {
        EXPECT_EQ(read(small).mesh.points.size(), 3U) << small;
    }
    EXPECT_THROW(read("1E400"), Error);
}

}  // namespace
}  // namespace bandvox

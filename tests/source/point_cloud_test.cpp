#include "source/mesh_files.h"

#include <bandvox/core/error.h>
#include <bandvox/source/point_cloud.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using test::bytesOf;
using test::TemporaryFolder;

// Two points with all that there may be, and colours that nobody asks for.
const Vec3d kFirst(0.5, -2, 30), kSecond(-1.25, 4, 0.125);

std::string plyHead(const std::string& format, const std::string& count = "2") {
    return "ply\nformat " + format + " 1.0\ncomment points\nelement vertex " + count +
           "\nproperty double x\nproperty float y\nproperty float z\nproperty uchar red\n"
           "property float nx\nproperty float ny\nproperty float nz\nproperty short pscale\n"
           "end_header\n";
}

std::string binaryPly(bool bigEndian) {
    std::string bytes = plyHead(bigEndian ? "binary_big_endian" : "binary_little_endian");
    for (const auto& [point, radius] : {std::pair(kFirst, 3), std::pair(kSecond, 7)}) {
        bytes += bytesOf(point[0], bigEndian);
        bytes += bytesOf(static_cast<float>(point[1]), bigEndian);
        bytes += bytesOf(static_cast<float>(point[2]), bigEndian);
        bytes += '\xFF';
        for (const float part : {0.0F, -1.0F, 0.5F}) bytes += bytesOf(part, bigEndian);
        bytes += bytesOf(static_cast<std::int16_t>(radius), bigEndian);
    }
    return bytes;
}

void expectAll(const PointCloud& cloud) {
    ASSERT_EQ(cloud.points.size(), 2U);
    EXPECT_EQ(cloud.points[0], kFirst);
    EXPECT_EQ(cloud.points[1], kSecond);
    EXPECT_EQ(cloud.normals, std::vector<openvdb::Vec3f>(2, {0, -1, 0.5F}));
    EXPECT_EQ(cloud.radii, (std::vector<double>{3, 7}));
}

TEST(PointCloud, ReadsTheSameFromEveryFormat) {
    const TemporaryFolder folder;
    const std::string rows = "0.5 -2 30 255 0 -1 .5 3\n-1.25 +4 1.25e-1 0 0 -1 0.5 7\n";
    std::string commas = rows, tabs = rows;
    for (char& c : commas) c = c == ' ' ? ',' : c;
    for (char& c : tabs) c = c == ' ' ? '\t' : c;
    const std::vector<std::pair<std::string, std::string>> files{
        {"text.ply", plyHead("ascii") + rows},
        {"little.PLY", binaryPly(false)},
        {"big.ply", binaryPly(true)},
        {"a.xyz", "x y z red nx ny nz radius\n" + rows},
        {"b.xyz", "//X Y Z red Nx Ny Nz radius\n# nothing\n\n" + rows},
        {"a.csv", "x,y,z,name,nx,ny,nz,Radius\n" + commas},
        {"b.txt", "\xEF\xBB\xBF\"x\"\ty\tz\tname\tnx\tny\tnz\tpscale\r\n" + tabs},
        {"c.csv",
         "scale;nz;ny;nx;word;z;y;x\n3;0.5;-1;0;any, thing;30;-2;0.5\n7; 0.5;-1;0;;0.125;4;-1.25"},
        {"d.csv",
         "x,y,z,nx,ny,nz,width\n0.5,-2,30,0,-1,0.5,6\n# between\n-1.25,4,0.125,0,-1,0.5,14\n"}};
    for (const auto& [name, bytes] : files) {
        SCOPED_TRACE(name);
        expectAll(readPointCloud(folder.write(name, bytes)));
    }
}

TEST(PointCloud, TellsColumnsWithoutNamesByTheirNumber) {
    const TemporaryFolder folder;
    const PointCloud bare = readPointCloud(folder.write("3.xyz", "1 2 3\n4 5 6\n"));
    EXPECT_EQ(bare.points, (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_TRUE(bare.normals.empty());
    EXPECT_TRUE(bare.radii.empty());
    EXPECT_EQ(readPointCloud(folder.write("4.csv", "1,2,3,0.5\n")).radii, std::vector{0.5});
    const PointCloud normals = readPointCloud(folder.write("6.txt", "1 2 3 0 0 1\n"));
    EXPECT_EQ(normals.normals, (std::vector<openvdb::Vec3f>{{0, 0, 1}}));
}

TEST(PointCloud, TellsPointsFromMeshes) {
    const TemporaryFolder folder;
    EXPECT_TRUE(isPointCloudFile("a.XYZ"));
    EXPECT_TRUE(isPointCloudFile("missing.csv"));
    EXPECT_FALSE(isPointCloudFile("missing.ply"));
    EXPECT_FALSE(isPointCloudFile("a.obj"));
    EXPECT_TRUE(isPointCloudFile(folder.write("points.ply", plyHead("ascii"))));
    const std::string mesh =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face ";
    const std::string list = "\nproperty list uchar int vertex_indices\nend_header\n";
    EXPECT_FALSE(isPointCloudFile(folder.write("mesh.ply", mesh + "1" + list)));
    EXPECT_TRUE(isPointCloudFile(folder.write("none.ply", mesh + "0" + list)));
    EXPECT_FALSE(isPointCloudFile(folder.write("broken.ply", "ply\nformat none\n")));
}

TEST(PointCloud, PassesOverWhatStandsBeforeThePoints) {
    const TemporaryFolder folder;
    const std::string head =
        "ply\nformat binary_little_endian 1.0\nelement camera 2\nproperty float f\n"
        "property uchar g\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n";
    std::string bytes = head + std::string(10, 'c');
    for (const float part : {1.0F, 2.0F, 3.0F}) bytes += bytesOf(part);
    EXPECT_EQ(readPointCloud(folder.write("a.ply", bytes)).points, std::vector{Vec3d(1, 2, 3)});
}

TEST(PointCloud, SaysWhatIsWrongAndWhere) {
    const TemporaryFolder folder;
    const auto expect = [&](const std::string& name, const std::string& bytes,
                            const std::vector<std::string>& words) {
        try {
            readPointCloud(folder.write(name, bytes));
            ADD_FAILURE() << bytes << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Input);
            for (const std::string& word : words) {
                EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
                    << error.what() << " has no " << word;
            }
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
        }
    };
    expect("a.xyz", "1 2 3\n4 five 6\n", {"line 2", "\"five\"", "column 2, y", "number"});
    expect("a.csv", "x,y,z\n1,2,\n", {"line 2", "nothing", "column 3, z"});
    expect("a.csv", "1;2,5;3\n", {"line 1", "'x'"});
    expect("a.xyz", "1 2 3\n4 5\n", {"line 2", "2 columns", "expected 3"});
    expect("a.xyz", "1 2 3\n4 5 6 7\n", {"line 2", "4 columns"});
    expect("a.xyz", "1 2\n", {"line 1", "2 numbers", "expected 3"});
    expect("a.xyz", "1 2 3\n\n1 nan 3\n", {"line 3", "nan as y", "finite"});
    expect("a.xyz", "1 2 1e99\n", {"line 1", "1e+99 as z"});
    expect("a.xyz", "1 2 3 -1\n", {"line 1", "radius -1", "0 or more"});
    expect("a.xyz", "1 2 3 255 0 0\n", {"line 1", "length 255", "names the columns"});
    expect("a.csv", "x,y\n1,2\n", {"line 1", "'z'"});
    expect("a.csv", "x,y,z,nx\n1,2,3,4\n", {"line 1", "'ny'"});
    expect("a.csv", "x,y,z,radius,width\n1,2,3,4,5\n", {"'radius'", "'width'"});
    expect("a.csv", "x,y,z\n", {"no points"});
    expect("a.csv", "# nothing\n", {"no points"});
    expect("a.csv", "", {"is empty"});
    expect("a.abc", "1 2 3\n", {"unknown kind"});

    const std::string row = "1 2 3 4 5 6 7 8\n";
    expect("a.ply", plyHead("ascii", "0"), {"no points"});
    expect("a.ply", plyHead("ascii", "9000000000000") + row, {"9000000000000 points", "short"});
    expect("a.ply", plyHead("ascii") + row, {"2 points", "short"});
    expect("a.ply", plyHead("ascii") + row + "1 2 3 4 5 6 seven 8\n", {"line 15", "\"seven\""});
    expect("a.ply", plyHead("ascii") + row + "1 2 3 4 5\n   \n1\n2\n3\n", {"5 numbers", "8"});
    expect("a.ply", plyHead("ascii") + row + "1 2 3 4 5 6 7 -8\n", {"point 2", "radius -8"});
    expect("a.ply", plyHead("ascii") + row + "1 2 inf 4 5 6 7 8\n", {"line 15", "inf"});
    std::string binary = binaryPly(false);
    expect("a.ply", binary.substr(0, binary.size() - 1), {"2 points", "1 at most"});
    expect("a.ply", plyHead("binary_little_endian", "99999999999999"), {"short"});
    const std::string nan = bytesOf(std::numeric_limits<double>::quiet_NaN());
    binary.replace(plyHead("binary_little_endian").size(), nan.size(), nan);
    expect("a.ply", binary, {"point 1", "nan as x"});
    expect("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
           "end_header\n1 2\n",
           {"'z'"});
}

TEST(PointCloud, StopsWhenAsked) {
    class Stop : public Progress {
      public:
        bool interrupted() const override { return true; }
    } stop;
    const TemporaryFolder folder;
    try {
        readPointCloud(folder.write("a.xyz", "1 2 3\n"), stop);
        ADD_FAILURE() << "it went on";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

}  // namespace
}  // namespace bandvox

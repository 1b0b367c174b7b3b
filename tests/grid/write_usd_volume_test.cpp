// A .usda file says of grids what the schemas of UsdVol ask for.

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/write_usd_volume.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace bandvox {
namespace {

openvdb::FloatGrid::Ptr gridNamed(const std::string& name) {
    auto grid = openvdb::FloatGrid::create();
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->fill(openvdb::CoordBBox(openvdb::Coord(-2, 0, 4), openvdb::Coord(1, 3, 9)), 1.0f);
    return grid;
}

std::string usdOf(const openvdb::GridCPtrVec& grids, const std::string& vdb = "a.vdb",
                  bool half = false) {
    const auto path = std::filesystem::path(testing::TempDir()) / "write_usd_volume.usda";
    AtomicFile file(path);
    writeUsdVolume(file, vdb, grids, half);
    file.commit();
    std::ifstream stream(path);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(path);
    return text;
}

void expectLine(const std::string& text, const std::string& line) {
    EXPECT_NE(text.find(" " + line + "\n"), std::string::npos) << line << " in\n" << text;
}

TEST(WriteUsdVolume, IsThatOfOneGrid) {
    EXPECT_EQ(usdOf({gridNamed("density")}), R"(#usda 1.0
(
    defaultPrim = "Volume"
    metersPerUnit = 1
    upAxis = "Y"
)

def Volume "Volume"
{
    float3[] extent = [(-1.25, -0.25, 1.75), (0.75, 1.75, 4.75)]
    rel field:density = </Volume/density>

    def OpenVDBAsset "density"
    {
        asset filePath = @./a.vdb@
        token fieldName = "density"
        token fieldClass = "fogVolume"
        token fieldDataType = "float"
    }
}
)");
}

TEST(WriteUsdVolume, NamesAreIdentifiersAndDiffer) {
    const std::string text =
        usdOf({gridNamed("density"), gridNamed("density"), gridNamed("density_2"),
               gridNamed("3 \"quotes\""), gridNamed("")});
    for (const char* name : {"density", "density_2", "density_2_2", "_3__quotes_", "_"}) {
        expectLine(text, std::string("rel field:") + name + " = </Volume/" + name + ">");
        expectLine(text, std::string("def OpenVDBAsset \"") + name + "\"");
    }
    expectLine(text, R"(token fieldName = "3 \"quotes\"")");
}

TEST(WriteUsdVolume, SaysWhatValuesAre) {
    auto colors = openvdb::Vec3SGrid::create();
    colors->setName("Cd");
    auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("vel");
    velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    velocity->setGridClass(openvdb::GRID_STAGGERED);
    auto distance = openvdb::DoubleGrid::create();
    distance->setName("surface");
    distance->setGridClass(openvdb::GRID_LEVEL_SET);
    const std::string text =
        usdOf({gridNamed("density"), colors, velocity, distance}, "a.vdb", true);
    for (const char* line :
         {R"(token fieldDataType = "half")", R"(token fieldDataType = "half3")",
          R"(token fieldDataType = "double")", R"(token vectorDataRoleHint = "Color")",
          R"(token vectorDataRoleHint = "Vector")", R"(token fieldClass = "unknown")",
          R"(token fieldClass = "staggered")", R"(token fieldClass = "levelSet")"}) {
        expectLine(text, line);
    }
}

TEST(WriteUsdVolume, HoldsAllCornersOfATurnedGrid) {
    auto grid = gridNamed("density");
    openvdb::Mat4d turn = openvdb::Mat4d::identity();
    turn.setToRotation(openvdb::Vec3d(0, 0, 1), 3.14159265358979 / 4);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(turn));
    // A square of side 4 around (-0.5, 1.5) is sqrt(32) wide when it stands on a corner.
    const std::string text = usdOf({grid});
    const std::string start = "extent = [(";
    const double lowest = std::stod(text.substr(text.find(start) + start.size()));
    const double highest = std::stod(text.substr(text.find("), (") + 4));
    EXPECT_NEAR(highest - lowest, std::sqrt(32.0), 1e-5);
}

TEST(WriteUsdVolume, NamesOfFilesAreMarked) {
    expectLine(usdOf({gridNamed("density")}, "me@work.vdb"),
               "asset filePath = @@@./me@work.vdb@@@");
    expectLine(usdOf({gridNamed("density")}, "/tmp/a.vdb"), "asset filePath = @/tmp/a.vdb@");
    EXPECT_THROW(usdOf({gridNamed("density")}, "a@@@b.vdb"), Error);
    EXPECT_THROW(usdOf({gridNamed("density")}, "a\nb.vdb"), Error);
}

TEST(WriteUsdVolume, RefusesWhatIsEmpty) {
    EXPECT_THROW(usdOf({}), Error);
    EXPECT_THROW(usdOf({openvdb::FloatGrid::create()}), Error);
}

}  // namespace
}  // namespace bandvox

#include "source/mesh_files.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/read_scattered_points.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using test::bytesOf;
using test::TemporaryFolder;

using Texts = std::vector<std::string>;

std::string plyOf(const std::string& format, const std::string& count = "2") {
    return "ply\nformat " + format + " 1.0\nelement camera 1\nproperty int id\nelement vertex " +
           count +
           "\nproperty double x\nproperty float y\nproperty float z\nproperty short heat\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
}

std::string binaryPly(bool bigEndian) {
    std::string bytes = plyOf(bigEndian ? "binary_big_endian" : "binary_little_endian");
    bytes += bytesOf(std::int32_t{77}, bigEndian);
    for (const double shift : {0.0, 1.0}) {
        bytes += bytesOf(0.5 + shift, bigEndian);
        bytes += bytesOf(static_cast<float>(2 + shift), bigEndian);
        bytes += bytesOf(static_cast<float>(3 + shift), bigEndian);
        bytes += bytesOf(static_cast<std::int16_t>(-7), bigEndian);
        bytes += "\xFF\xBC";
        bytes += '\0';
    }
    return bytes;
}

void expectCloud(const ScatteredPoints& points) {
    EXPECT_EQ(points.names, (Texts{"heat", "red", "green", "blue"}));
    EXPECT_EQ(points.x, (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(points.y, (std::vector<double>{2, 3}));
    EXPECT_EQ(points.z, (std::vector<double>{3, 4}));
    EXPECT_EQ(lineOfPoint(points, 1), " (point 2)");
    ASSERT_EQ(points.columns, 4);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(points.value(i, 0), -7);
        // Bytes are sRGB: 0xBC, the code 188, is half of the light.
        EXPECT_EQ(points.value(i, 1), 1);
        EXPECT_NEAR(points.value(i, 2), 0.5029, 1e-4);
        EXPECT_EQ(points.value(i, 3), 0);
    }
}

TEST(ReadScatteredPoints, TakesThePointsOfPlyFiles) {
    const TemporaryFolder folder;
    PointColumnChoice inSpace;
    inSpace.isInSpace = true;
    const std::string text = "77\n.5 2 3 -7 255 188 0\n1.5 3 4 -7 255 188 0\n";
    for (const auto& [name, bytes] :
         {std::pair<std::string, std::string>{"text.ply", plyOf("ascii") + text},
          {"little.ply", binaryPly(false)},
          {"big.PLY", binaryPly(true)}}) {
        SCOPED_TRACE(name);
        expectCloud(readScatteredPoints(folder.write(name, bytes), inSpace));
    }
    // In a plane z is a value as others are.
    const ScatteredPoints flat = readScatteredPoints(folder.write("flat.ply", binaryPly(false)));
    EXPECT_EQ(flat.names.front(), "z");
    EXPECT_FALSE(flat.isInSpace());
    PointColumnChoice chosen;
    chosen.columns = {"z", "x", "heat"};
    const ScatteredPoints some =
        readScatteredPoints(folder.write("some.ply", binaryPly(false)), chosen);
    EXPECT_EQ(some.x, (std::vector<double>{3, 4}));
    EXPECT_EQ(some.names, Texts{"heat"});
}

std::string npyOf(const std::string& type, const std::string& order, const std::string& shape,
                  const std::string& numbers) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (";
    header += shape + "), }";
    header.resize(118, ' ');
    return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + numbers;
}

TEST(ReadScatteredPoints, TakesArraysOfEveryType) {
    const TemporaryFolder folder;
    const std::vector<std::vector<int>> rows{{1, 2, 3}, {4, 5, 6}};
    std::string shorts, bigDoubles, columns;
    for (const auto& row : rows) {
        for (const int number : row) {
            shorts += bytesOf(static_cast<std::int16_t>(number), false);
            bigDoubles += bytesOf(static_cast<double>(number), true);
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        for (const auto& row : rows) columns += bytesOf(static_cast<float>(row[c]), false);
    }
    for (const auto& bytes :
         {npyOf("<i2", "False", "2, 3", shorts), npyOf(">f8", "False", "2, 3", bigDoubles),
          npyOf("<f4", "True", "2, 3", columns)}) {
        const ScatteredPoints points = readScatteredPoints(folder.write("a.npy", bytes));
        EXPECT_EQ(points.x, (std::vector<double>{1, 4}));
        EXPECT_EQ(points.y, (std::vector<double>{2, 5}));
        EXPECT_EQ(points.values, (std::vector<double>{3, 6}));
    }
}

void expectRefused(const std::string& name, const std::string& bytes, const Texts& words) {
    const TemporaryFolder folder;
    try {
        readScatteredPoints(folder.write(name, bytes));
        ADD_FAILURE() << "no error for " << words.front();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input) << error.what();
        for (const std::string& word : words) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
                << word << " in: " << error.what();
        }
    }
}

TEST(ReadScatteredPoints, SaysWhatIsWrongInAFile) {
    const std::string bytes = binaryPly(false);
    expectRefused("a.ply", bytes.substr(0, bytes.size() - 1), {"2 points", "short"});
    expectRefused("a.ply", plyOf("ascii", "1000000000") + "77\n1 2 3 4 5 6 7\n",
                  {"1000000000 points", "short"});
    expectRefused("a.ply", plyOf("ascii") + "77\n1 2 3 4 5 6 7\n1 2 3 4 5 six 7\n",
                  {"line 16", "\"six\""});
    expectRefused("a.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n", {"no points"});
    std::string infinite = bytes;
    infinite.replace(bytes.size() - 13, 4, bytesOf(std::numeric_limits<float>::infinity(), false));
    expectRefused("a.ply", infinite, {"point 2", "inf"});
    expectRefused("a.npy", npyOf("<f8", "False", "2, 3", std::string(40, '\0')),
                  {"2 rows of 3", "40 bytes"});
    expectRefused("a.npy", npyOf("<f8", "False", "-2, -3", std::string(48, '\0')), {"size -2"});
    expectRefused("a.npy", npyOf("<f8", "False", "6", std::string(48, '\0')), {"sizes", "2"});
    expectRefused("a.npy", npyOf("<c8", "False", "1, 3", std::string(24, '\0')), {"type", "c8"});
    expectRefused("a.npy", npyOf("<f8", "False", "0, 3", ""), {"no points"});
}

}  // namespace
}  // namespace bandvox

#include "source/file_integrity.h"
#include "source/mesh_files.h"
#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <map>
#include <random>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Vec3d;
using test::TemporaryFolder;

/// The message of the error that reading gives, or "" if it gives none.
std::string messageOf(const fs::path& path) {
    try {
        readMesh(path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos)
            << "the file is not named: " << error.what();
        return error.what();
    }
    return "";
}

void expectMessage(const fs::path& path, const std::string& part) {
    const std::string message = messageOf(path);
    EXPECT_NE(message.find(part), std::string::npos) << path << ": " << message;
}

double closedVolume(const fs::path& path) {
    return test::volume(closeMesh(readMesh(path).mesh).mesh);
}

/// A shape without symmetry, so that no exchange of axes goes unseen.
Mesh solid() {
    Mesh mesh = test::cube(Vec3d(0.5, -1.0, 0.25), 2.0);
    for (Vec3d& p : mesh.points) p += Vec3d(0.25 * p.y(), 0.5 * p.z(), 0.0);
    return mesh;
}
constexpr double kSolidVolume = 8.0;

/// A file of each kind that refers to points by index, and that a test can write by itself.
std::map<std::string, std::string> indexedFilesOf(const Mesh& mesh) {
    return {{"a.obj", test::objText(mesh)},
            {"b.OBJ", test::objText(mesh)},
            {"a.off", test::offText(mesh)},
            {"text.ply", test::plyText(mesh)},
            {"little.ply", test::plyBinary(mesh, false)},
            {"big.ply", test::plyBinary(mesh, true)},
            {"a.gltf", test::embeddedGltf(mesh, R"({"mesh":0})", 1)},
            {"a.glb", test::glb(mesh, R"({"mesh":0})", 1)}};
}

/// The same, and those that repeat the points of each triangle.
std::map<std::string, std::string> filesOf(const Mesh& mesh) {
    std::map<std::string, std::string> files = indexedFilesOf(mesh);
    files["text.stl"] = test::stlText(mesh);
    files["binary.stl"] = test::stlBinary(mesh);
    files["misleading.stl"] = test::stlBinary(mesh, "solid but binary");
    return files;
}

TEST(ReadMesh, ReadsTheSameSolidFromEveryFormat) {
    const TemporaryFolder folder;
    for (const auto& [name, bytes] : filesOf(solid())) {
        const MeshFile file = readMesh(folder.write(name, bytes));
        EXPECT_EQ(file.objects, 1u) << name;
        EXPECT_EQ(file.mesh.triangles.size(), 12u) << name;
        EXPECT_TRUE(file.warnings.empty()) << name << ": " << file.warnings.front();
        EXPECT_NEAR(test::volume(file.mesh), kSolidVolume, 1e-5) << name;
        openvdb::BBoxd box;
        for (const Vec3d& p : file.mesh.points) box.expand(p);
        EXPECT_LT((box.min() - Vec3d(0.25, -0.875, 0.25)).length(), 1e-6) << name << box;
        EXPECT_LT((box.max() - Vec3d(2.75, 2.125, 2.25)).length(), 1e-6) << name << box;
        EXPECT_TRUE(closeMesh(file.mesh).report.warnings.empty()) << name;
    }
}

TEST(ReadMesh, ReadsWhatTheExporterWrites) {
    const TemporaryFolder folder;
    Assimp::Importer importer;
    const auto original = folder.write("original.obj", test::objText(solid()));
    const aiScene* scene = importer.ReadFile(original.string(), 0);
    ASSERT_NE(scene, nullptr);
    for (const auto& [format, name] : {std::pair("fbxa", "text.fbx"), std::pair("collada", "a.dae"),
                                       std::pair("glb2", "a.glb"), std::pair("plyb", "a.ply")}) {
        const fs::path path = folder.path() / name;
        ASSERT_EQ(Assimp::Exporter().Export(scene, format, path.string()), aiReturn_SUCCESS)
            << format;
        EXPECT_NEAR(closedVolume(path), kSolidVolume, 1e-5) << format;

        // Cut short, each is refused.
        const std::string bytes = readFile(path).bytes;
        for (std::size_t part = 1; part < 16; ++part) {
            const auto cut =
                folder.write("cut_" + std::string(name), bytes.substr(0, bytes.size() * part / 16));
            EXPECT_FALSE(messageOf(cut).empty()) << name << " at " << part << "/16";
        }
    }
}

TEST(ReadMesh, SplitsPolygonsOfAnyNumberOfCorners) {
    const TemporaryFolder folder;
    // A prism over a concave polygon of 7 corners and area 5.5, sides as quadrilaterals.
    const std::vector<std::array<double, 2>> outline = {{0, 0}, {3, 0},   {3, 3}, {2, 1},
                                                        {1, 2}, {0.5, 1}, {0, 2}};
    std::string text = "# prism\no prism\n";
    double area = 0.0;
    for (std::size_t i = 0; i < 7; ++i) {
        const auto& [x, y] = outline[i];
        const auto& [nx, ny] = outline[(i + 1) % 7];
        area += 0.5 * (x * ny - nx * y);
        for (const int z : {0, 2}) {
            text +=
                "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
        }
    }
    std::string bottom;
    std::string top;
    for (int i = 0; i < 7; ++i) {
        const int next = (i + 1) % 7;
        // Count back from the end for the sides, and continue one line on the next.
        text += "f " + std::to_string(2 * i - 14) + " " + std::to_string(2 * next - 14) + " \\\n " +
                std::to_string(2 * next - 13) + " " + std::to_string(2 * i - 13) + "\n";
        bottom = " " + std::to_string(2 * i + 1) + bottom;
        top += " " + std::to_string(2 * i + 2);
    }
    const auto path = folder.write("prism.obj", text + "f" + bottom + "\nf" + top + "\n");
    const ClosedMesh closed = closeMesh(readMesh(path).mesh);
    EXPECT_TRUE(closed.report.warnings.empty()) << closed.report.warnings.front();
    EXPECT_EQ(closed.mesh.triangles.size(), 2u * 7 + 2 * 5);
    EXPECT_NEAR(test::volume(closed.mesh), 2.0 * area, 1e-5);
}

TEST(ReadMesh, PlacesObjectsByTheirNodes) {
    const TemporaryFolder folder;
    // Twice the size; and reflected, half as high and out of the way.
    const std::string nodes =
        R"({"mesh":0,"scale":[2,2,2]},{"translation":[20,0,0],"children":[2]},)"
        R"({"mesh":0,"scale":[-1,0.5,1]})";
    Mesh mesh = solid();
    const std::string gltf = test::embeddedGltf(mesh, nodes, 2);
    const std::string glb = test::glb(mesh, nodes, 2);
    for (const auto& path : {folder.write("a.gltf", gltf), folder.write("a.glb", glb)}) {
        const MeshFile file = readMesh(path);
        EXPECT_EQ(file.objects, 2u);
        const ClosedMesh closed = closeMesh(file.mesh);
        EXPECT_EQ(closed.report.components, 2u);
        EXPECT_EQ(closed.report.componentsTurned, 0u) << "a reflection turned its object";
        EXPECT_NEAR(test::volume(closed.mesh), kSolidVolume * (8.0 + 0.5), 1e-4);
        openvdb::BBoxd box;
        for (const Vec3d& p : file.mesh.points) box.expand(p);
        EXPECT_NEAR(box.max().x(), 20.0 - 0.25, 1e-5);
    }
}

TEST(ReadMesh, LeavesOutPointsAndLines) {
    const TemporaryFolder folder;
    const auto path = folder.write("lines.obj", test::objText(solid()) + "v 9 9 9\nl 1 9\np 9\n");
    const MeshFile file = readMesh(path);
    EXPECT_EQ(file.mesh.triangles.size(), 12u);
    EXPECT_NEAR(test::volume(file.mesh), kSolidVolume, 1e-5);
    EXPECT_FALSE(file.warnings.empty());
}

TEST(ReadMesh, RefusesWhatIsNotAMeshFile) {
    const TemporaryFolder folder;
    expectMessage(folder.path() / "missing.obj", "does not exist");
    fs::create_directory(folder.path() / "folder.obj");
    expectMessage(folder.path() / "folder.obj", "is a folder");
    expectMessage("/dev/null", "not a regular file");
    for (const std::string& extension : meshExtensions()) {
        expectMessage(folder.write("empty" + extension, ""), "is empty");
        EXPECT_FALSE(messageOf(folder.write("blank" + extension, "\n\n\n")).empty()) << extension;
        EXPECT_FALSE(
            messageOf(folder.write("noise" + extension, std::string(3000, '\xab'))).empty())
            << extension;
        EXPECT_FALSE(messageOf(folder.write("zeros" + extension, std::string(3000, '\0'))).empty())
            << extension;
    }
    const auto picture = folder.write("picture.png", "x");
    for (const std::string& extension : meshExtensions()) expectMessage(picture, extension);
    EXPECT_TRUE(isMeshFile("a/b.StL"));
    EXPECT_FALSE(isMeshFile("obj"));
    EXPECT_FALSE(isMeshFile(""));
}

TEST(ReadMesh, RefusesFilesThatAreCutShort) {
    const TemporaryFolder folder;
    for (const auto& [name, bytes] : filesOf(solid())) {
        // An obj file that ends when all points are used could be whole.
        const bool noCounts = name.ends_with("obj") || name.ends_with("OBJ");
        for (std::size_t part = 1; part < (noCounts ? 18 : 24); ++part) {
            const auto path = folder.write(name, bytes.substr(0, bytes.size() * part / 24));
            EXPECT_FALSE(messageOf(path).empty()) << name << " at " << part << "/24";
        }
    }
    const Mesh mesh = solid();
    expectMessage(folder.write("a.stl", test::stlBinary(mesh).substr(0, 600)), "684");
    expectMessage(folder.write("b.stl", test::stlText(mesh).substr(0, 600)), "endsolid");
    expectMessage(folder.write("a.ply", test::plyText(mesh).substr(0, 250)), "cut short");
    expectMessage(folder.write("b.ply", test::plyBinary(mesh, true).substr(0, 320)), "cut short");
    expectMessage(folder.write("a.off", test::offText(mesh).substr(0, 60)), "cut short");
    expectMessage(folder.write("a.glb", test::glb(mesh, "{}", 1).substr(0, 600)), "600 bytes");
}

TEST(ReadMesh, RefusesFilesOfOneFormatThatAreDamaged) {
    const TemporaryFolder folder;
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    const auto obj = [&folder](const std::string& text, const std::string& message) {
        expectMessage(folder.write("a.obj", text), message);
    };
    obj(points, "no faces");
    obj("f 1 2 3\n", "the file has 0");
    obj(points + "f 1 2\n", "line 5 has a face with 2 corners");
    obj(points + "f\n", "with 0 corners");
    obj(points + "v 1 2\n" + faces, "line 5 has a point with 2 coordinates");
    obj(points + "v 1 2 x\n" + faces, "\"x\"");
    obj(points + "v 1 nan 2\n" + faces, "nan");
    obj(points + "v 1 1e99 2\n" + faces, "finite");
    obj(points + "v 1 1e999 2\n" + faces, "finite");
    obj(points + "v 1 -inf 2\n" + faces, "-inf");
    obj(points + faces + "f 1 2 5\n", "line 9 refers to point 5; the file has 4");
    obj(points + faces + "f 1 2 0\n", "point 0");
    obj(points + faces + "f 1 2 -5\n", "point -5");
    obj(points + faces + "f 1 2 99999999999999999\n", "the file has 4");
    obj(points + faces + "f 1 2 9999999999999999999999\n", "corner");
    obj(points + faces + "f 1/1 2/1 3/1\n", "texture coordinate 1");
    obj(points + faces + "f 1//2 2//1 3//1\n", "normal 2");
    obj(points + faces + "f a b c\n", "\"a\"");
    obj(points + "v 5 5 5\nv 6 6 6\n" + faces.substr(0, faces.size() - 1), "cut short");

    const auto off = [&folder](const std::string& text, const std::string& message) {
        expectMessage(folder.write("a.off", text), message);
    };
    off("FFO\n4 4 0\n", "expected \"OFF\"");
    off("OFF\n", "cut short");
    off("OFF\n4\n", "counts");
    off("OFF\n-4 4 0\n", "negative");
    off("OFF BINARY\n", "binary");
    off("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no faces");
    off("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 4 has a point with 2");
    off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "point 3");
    off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "point -1");
    off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", "4 corners with 3");
    off("OFF\n999999999999999 1 0\n0 0 0\n", "cut short");

    const auto ply = [&folder](const std::string& text, const std::string& message) {
        expectMessage(folder.write("a.ply", text), message);
    };
    const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + vertex;
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(messageOf(folder.write("good.ply", head + face + three + "3 0 1 2\n")), "");
    ply("plx\n", "\"ply\"");
    ply(head, "end_header");
    ply("ply\nend_header\n", "format");
    ply("ply\nformat odd 1.0\nend_header\n", "format");
    ply(head + "end_header\n" + three, "no faces");
    ply(head + face + three + "3 0 1 3\n", "point 3");
    ply(head + face + three + "3 0 1 -1\n", "point -1");
    ply(head + face + three + "3 0 1\n", "item 1 of 1 of its element \"face\"");
    ply(head + face + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "nan");
    ply(head + "property real w\n" + face, "type");
    ply(head + "property float\n" + face, "incomplete property");
    ply("ply\nformat ascii 1.0\nelement vertex 99999999999\n" + vertex + face + three, "cut short");
    ply("ply\nformat ascii 1.0\nelement vertex 99999999999\n" + face, "cut short");

    expectMessage(folder.write("a.stl", "solid x\nendsolid x\n"), "no facets");
    expectMessage(folder.write("b.stl", test::stlBinary(Mesh{})), "no facets");
    expectMessage(folder.write("c.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n"),
                  "line 4");
    expectMessage(folder.write("d.stl",
                               "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\n"
                               "endloop\nendfacet\nendsolid\n"),
                  "1 corners");
}

TEST(ReadMesh, RefusesBadIndicesAndCoordinatesInAnyFormat) {
    const TemporaryFolder folder;
    Mesh outOfRange = solid();
    outOfRange.triangles[5][1] = 8;
    for (const auto& [name, bytes] : indexedFilesOf(outOfRange)) {
        EXPECT_FALSE(messageOf(folder.write(name, bytes)).empty()) << name;
    }
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Mesh mesh = solid();
        mesh.points[3].y() = bad;
        for (const auto& [name, bytes] : filesOf(mesh)) {
            const std::string message = messageOf(folder.write(name, bytes));
            EXPECT_NE(message.find("finite"), std::string::npos) << name << ": " << message;
        }
    }
}

TEST(ReadMesh, WarnsOfPointsThatNoFaceUses) {
    const TemporaryFolder folder;
    Mesh mesh = solid();
    mesh.points.emplace_back(7, 8, 9);
    for (const auto& path :
         {folder.write("a.obj", test::objText(mesh)), folder.write("a.off", test::offText(mesh)),
          folder.write("a.ply", test::plyText(mesh))}) {
        const MeshFile file = readMesh(path);
        ASSERT_EQ(file.warnings.size(), 1u) << path;
        EXPECT_EQ(file.warnings[0], "1 of its 9 points are in no face");
    }
}

TEST(ReadMesh, SurvivesDamageAnywhere) {
    // Whatever is in the bytes, the answer is a mesh with valid indices or one clear error.
    const TemporaryFolder folder;
    std::mt19937 random(23);
    for (const auto& [name, bytes] : filesOf(solid())) {
        for (int trial = 0; trial < 40; ++trial) {
            std::string damaged = bytes;
            for (unsigned i = 0; i < 1 + random() % 4; ++i) {
                damaged[random() % damaged.size()] = static_cast<char>(random());
            }
            const auto path = folder.write(name, damaged);
            try {
                const MeshFile file = readMesh(path);
                for (const openvdb::Vec3I& t : file.mesh.triangles) {
                    for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], file.mesh.points.size());
                }
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::Input) << name;
            }
        }
    }
}

TEST(ReadMesh, StopsWhenAskedAndTellsProgress) {
    class Counter final : public Progress {
      public:
        void advance(std::int64_t steps) override { mSteps += steps; }
        bool interrupted() const override { return mStop; }
        std::int64_t mSteps = 0;
        bool mStop = false;
    };
    const TemporaryFolder folder;
    const auto path = folder.write("a.obj", test::objText(solid()));
    Counter counter;
    readMesh(path, counter);
    EXPECT_GT(counter.mSteps, 0);
    EXPECT_LE(counter.mSteps, 100);
    counter.mStop = true;
    try {
        readMesh(path, counter);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

TEST(ReadMesh, RealMeshesClose) {
    const char* data = std::getenv("BANDVOX_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    for (const char* name : {"stanford-bunny", "spot", "fandisk", "cow", "teapot"}) {
        const fs::path path = fs::path(data) / (std::string(name) + ".obj");
        if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
        const ClosedMesh closed = closeMesh(readMesh(path).mesh);
        EXPECT_TRUE(test::isClosed(closed.mesh)) << name;
        EXPECT_GT(test::volume(closed.mesh), 0.0) << name;
        if (std::string(name) == "stanford-bunny") {
            EXPECT_EQ(closed.report.holes.size(), 5u);
        }
        if (std::string(name) == "spot") {
            EXPECT_TRUE(closed.report.warnings.empty());
        }
    }
}

}  // namespace
}  // namespace bandvox

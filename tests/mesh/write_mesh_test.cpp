#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace bandvox::mesh_test {
namespace {

namespace fs = std::filesystem;
using openvdb::Vec3d;
using openvdb::Vec3f;

/// A folder of a test's own.
class MeshFiles : public testing::Test {
  protected:
    MeshFiles() {
        mFolder = fs::temp_directory_path() / ("bandvox_mesh_files_" + std::to_string(getpid()));
        fs::create_directories(mFolder);
    }
    ~MeshFiles() override { fs::remove_all(mFolder); }

    std::string write(const std::string& name, const SurfaceMesh& mesh) const {
        const fs::path path = mFolder / name;
        writeMesh(path, mesh);
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    fs::path mFolder;
};

/// An octahedron, whose colours tell the axes apart.
SurfaceMesh octahedron(const Vec3d& center = Vec3d(0.0), bool isColored = true) {
    SurfaceMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Vec3d direction(0.0);
            direction[axis] = side;
            mesh.mesh.points.push_back(center + (0.1 + 0.7 * axis) * direction);
            mesh.normals.emplace_back(direction);
            Vec3f color(0.05F);
            color[axis] = side < 0 ? 0.5F : 1.0F;
            if (isColored) mesh.colors.push_back(color);
        }
    }
    for (unsigned i = 0; i < 8; ++i) {
        const unsigned a = i & 1, b = 2 + (i >> 1 & 1), c = 4 + (i >> 2);
        const bool isEven = ((i & 1) + (i >> 1 & 1) + (i >> 2)) % 2 == 1;
        mesh.mesh.triangles.push_back(isEven ? openvdb::Vec3I(a, b, c) : openvdb::Vec3I(a, c, b));
    }
    return mesh;
}

/// The corners of all triangles, in order.
std::vector<Vec3d> cornersOf(const Mesh& mesh) {
    std::vector<Vec3d> corners;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) corners.push_back(mesh.points[t[k]]);
    }
    return corners;
}

TEST_F(MeshFiles, NotesComeBack) {
    const std::vector<std::string> notes{"settings: a=1", R"(input: "quoted" \ and ] [)",
                                         "input: \xc3\xa4 # note"};
    for (const char* name : {"a.ply", "a.obj", "a.gltf", "a.glb"}) {
        SurfaceMesh mesh = octahedron();
        write(name, mesh);
        EXPECT_EQ(readMeshNotes(mFolder / name), std::vector<std::string>{}) << name;
        mesh.notes = notes;
        write(name, mesh);
        EXPECT_EQ(readMeshNotes(mFolder / name), notes) << name;
        // They change nothing for whoever does not know of them.
        EXPECT_EQ(readMesh(mFolder / name).mesh.triangles.size(), 8u) << name;
    }
    SurfaceMesh mesh = octahedron(Vec3d(0.0), false);
    const std::string plain = write("a.stl", mesh);
    mesh.notes = notes;
    EXPECT_EQ(write("a.stl", mesh), plain);
    EXPECT_EQ(readMeshNotes(mFolder / "a.stl"), std::vector<std::string>{});
    EXPECT_EQ(readMeshNotes(mFolder / "none.ply"), std::vector<std::string>{});
}

TEST_F(MeshFiles, AChangedByteIsNoticed) {
    SurfaceMesh mesh = octahedron();
    mesh.notes = {"settings: a=1"};
    for (const char* name : {"a.ply", "a.obj", "a.gltf", "a.glb"}) {
        const std::string whole = write(name, mesh);
        EXPECT_TRUE(isAsWritten(mFolder / name)) << name;
        for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 97) {
            std::string changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ 1);
            std::ofstream(mFolder / name, std::ios::binary) << changed;
            EXPECT_FALSE(isAsWritten(mFolder / name)) << name << " at " << at;
        }
        std::ofstream(mFolder / name, std::ios::binary) << whole << ' ';
        EXPECT_FALSE(isAsWritten(mFolder / name)) << name << " with a byte more";
    }
    mesh.notes.clear();
    write("a.ply", mesh);
    EXPECT_FALSE(isAsWritten(mFolder / "a.ply")) << "without notes there is nothing to tell by";
    EXPECT_FALSE(isAsWritten(mFolder / "none.ply"));
}

TEST_F(MeshFiles, EveryFormatReadsBackAsItWas) {
    for (const std::string& extension : writableMeshExtensions()) {
        SCOPED_TRACE(extension);
        for (const bool isColored : {false, true}) {
            const SurfaceMesh mesh = octahedron({0.25, -3, 1}, isColored);
            write("mesh" + extension, mesh);
            const MeshFile file = readMesh(mFolder / ("mesh" + extension));
            EXPECT_TRUE(file.warnings.empty());
            const auto expected = cornersOf(mesh.mesh), found = cornersOf(file.mesh);
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_LT((found[i] - expected[i]).length(), 1e-6) << i;
            }
            // The importer takes points of the others apart.
            const bool isShared = extension != ".stl" && extension != ".obj";
            EXPECT_EQ(file.mesh.points.size(), isShared ? 6u : 24u);
        }
    }
}

TEST_F(MeshFiles, NormalsReadBackAsTheyWere) {
    const SurfaceMesh mesh = octahedron();
    for (const std::string extension : {".ply", ".obj", ".glb", ".gltf"}) {
        SCOPED_TRACE(extension);
        write("mesh" + extension, mesh);
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile((mFolder / ("mesh" + extension)).string(), 0);
        ASSERT_TRUE(scene != nullptr);
        ASSERT_EQ(scene->mNumMeshes, 1u);
        const aiMesh& read = *scene->mMeshes[0];
        ASSERT_TRUE(read.HasNormals());
        for (unsigned i = 0; i < read.mNumVertices; ++i) {
            const aiVector3D& n = read.mNormals[i];
            const aiVector3D& p = read.mVertices[i];
            // Each normal points away from the middle.
            EXPECT_GT(n.x * p.x + n.y * p.y + n.z * p.z, 0.09F);
            EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1, 1e-4);
        }
    }
}

TEST_F(MeshFiles, ColorsReadBackAsLinearLight) {
    const SurfaceMesh mesh = octahedron();
    for (const std::string extension : {".ply", ".obj", ".glb", ".gltf"}) {
        SCOPED_TRACE(extension);
        write("mesh" + extension, mesh);
        const ColoredMeshFile file = readColoredMesh(mFolder / ("mesh" + extension));
        ASSERT_EQ(file.colored.paints.size(), 8u);
        for (std::size_t t = 0; t < 8; ++t) {
            for (int k = 0; k < 3; ++k) {
                const Vec3f expected = mesh.colors[mesh.mesh.triangles[t][k]];
                const Vec3f found = file.colored.paints[t].color[k];
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 5e-3);
            }
        }
    }
    EXPECT_FALSE(holdsColors("a.stl"));
    EXPECT_TRUE(holdsColors("a.PLY"));
}

TEST_F(MeshFiles, StlHasFacetNormalsAndFiftyBytesForEachTriangle) {
    const std::string stl = write("mesh.stl", octahedron());
    ASSERT_EQ(stl.size(), 84u + 8 * 50);
    EXPECT_FALSE(stl.starts_with("solid"));
    EXPECT_EQ(stl[80], 8);
    for (std::size_t t = 0; t < 8; ++t) {
        float numbers[12];
        std::memcpy(numbers, stl.data() + 84 + 50 * t, sizeof numbers);
        // Of a plane that cuts the axes at 0.1, 0.8 and 1.5, in the corners' octant.
        const double length = std::hypot(1 / 0.1, 1 / 0.8, 1 / 1.5);
        const double axes[] = {0.1, 0.8, 1.5};
        for (int k = 0; k < 3; ++k) {
            double sum = 0;
            for (int corner = 1; corner < 4; ++corner) sum += numbers[3 * corner + k];
            EXPECT_NEAR(numbers[k], (sum > 0 ? 1 : -1) / (axes[k] * length), 1e-6);
        }
    }
}

TEST_F(MeshFiles, PlySaysWhatItHolds) {
    const std::string ply = write("mesh.ply", octahedron());
    const std::string::size_type end = ply.find("end_header\n") + 11;
    const std::string head = ply.substr(0, end);
    EXPECT_TRUE(head.starts_with("ply\nformat binary_little_endian 1.0\n"));
    EXPECT_NE(head.find("element vertex 6\nproperty float x\n"), std::string::npos);
    EXPECT_NE(head.find("property uchar red\nproperty uchar green\n"), std::string::npos);
    EXPECT_EQ(ply.size(), end + 6 * (24 + 3) + 8 * 13);
    // The first point, and its colour: half of the light is 188 of 255 in sRGB, 0.05 is 63.
    float x = 0;
    std::memcpy(&x, ply.data() + end, sizeof x);
    EXPECT_FLOAT_EQ(x, -0.1F);
    EXPECT_EQ(ply.substr(end + 24, 3), "\xBC\x3F\x3F");
    EXPECT_EQ(write("plain.ply", octahedron({}, false)).find("uchar red"), std::string::npos);
}

TEST_F(MeshFiles, GltfFollowsItsSpecification) {
    const std::string glb = write("mesh.glb", octahedron());
    ASSERT_EQ(glb.substr(0, 4), "glTF");
    std::uint32_t total = 0, textBytes = 0, bufferBytes = 0;
    std::memcpy(&total, glb.data() + 8, 4);
    std::memcpy(&textBytes, glb.data() + 12, 4);
    EXPECT_EQ(total, glb.size());
    EXPECT_EQ(textBytes % 4, 0u);
    std::memcpy(&bufferBytes, glb.data() + 20 + textBytes, 4);
    EXPECT_EQ(28 + textBytes + bufferBytes, total);
    const auto json = nlohmann::json::parse(glb.substr(20, textBytes));
    EXPECT_EQ(json.at("buffers").at(0).at("byteLength"), bufferBytes);
    EXPECT_EQ(json.at("asset").at("version"), "2.0");
    const auto& primitive = json.at("meshes").at(0).at("primitives").at(0);
    const auto& points =
        json.at("accessors").at(primitive.at("attributes").at("POSITION").get<int>());
    EXPECT_EQ(points.at("count"), 6);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(points.at("max").at(axis).get<float>(), static_cast<float>(0.1 + 0.7 * axis));
        EXPECT_EQ(points.at("min").at(axis).get<float>(), static_cast<float>(-0.1 - 0.7 * axis));
    }
    const auto& corners = json.at("accessors").at(primitive.at("indices").get<int>());
    EXPECT_EQ(corners.at("count"), 24);
    EXPECT_EQ(corners.at("componentType"), 5125);
    const auto& view = json.at("bufferViews").at(corners.at("bufferView").get<int>());
    EXPECT_EQ(view.at("byteOffset").get<unsigned>() + 24 * 4, bufferBytes);
    // The first colour is linear: half of red.
    const auto& colors =
        json.at("accessors").at(primitive.at("attributes").at("COLOR_0").get<int>());
    float red = 0;
    const auto offset =
        json.at("bufferViews").at(colors.at("bufferView").get<int>()).at("byteOffset").get<int>();
    std::memcpy(&red, glb.data() + 28 + textBytes + offset, 4);
    EXPECT_EQ(red, 0.5F);
    // The text form holds the same.
    const auto text = nlohmann::json::parse(write("mesh.gltf", octahedron()));
    EXPECT_EQ(text.at("accessors"), json.at("accessors"));
    EXPECT_EQ(text.at("bufferViews"), json.at("bufferViews"));
    const std::string uri = text.at("buffers").at(0).at("uri");
    EXPECT_EQ(uri.size(),
              std::strlen("data:application/octet-stream;base64,") + (bufferBytes + 2) / 3 * 4);
}

TEST_F(MeshFiles, MeshesFarFromTheOriginKeepTheirShape) {
    const Vec3d center(1e6, -2e6, 5e5);
    const SurfaceMesh mesh = octahedron(center);
    for (const std::string extension : {".ply", ".obj", ".gltf", ".glb"}) {
        SCOPED_TRACE(extension);
        const std::string bytes = write("mesh" + extension, mesh);
        if (extension == ".ply") {
            EXPECT_NE(bytes.find("property double x"), std::string::npos);
        }
        if (extension == ".obj") {
            EXPECT_NE(bytes.find("v 999999.9 -2e+06 5e+05 "), std::string::npos);
        }
        if (extension != ".glb") continue;
        std::uint32_t textBytes = 0;
        std::memcpy(&textBytes, bytes.data() + 12, 4);
        const auto json = nlohmann::json::parse(bytes.substr(20, textBytes));
        EXPECT_EQ(json.at("nodes").at(0).at("translation").at(0), 1e6);
        EXPECT_EQ(json.at("accessors").at(0).at("max").at(2).get<float>(), 1.5F);
    }
    try {
        write("mesh.stl", mesh);
        FAIL() << "expected an error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Result);
    }
    EXPECT_FALSE(fs::exists(mFolder / "mesh.stl"));
}

TEST_F(MeshFiles, RefusesWhatIsNoMesh) {
    const auto kindOf = [&](const std::string& name, const SurfaceMesh& mesh) {
        try {
            write(name, mesh);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Interrupted;
    };
    EXPECT_EQ(kindOf("mesh.off", octahedron()), ErrorKind::Usage);
    EXPECT_EQ(kindOf("mesh.ply", {}), ErrorKind::Usage);
    SurfaceMesh wrong = octahedron();
    wrong.mesh.triangles[3][1] = 6;
    EXPECT_EQ(kindOf("mesh.ply", wrong), ErrorKind::Usage);
    wrong = octahedron();
    wrong.normals.pop_back();
    EXPECT_EQ(kindOf("mesh.ply", wrong), ErrorKind::Usage);
    wrong = octahedron();
    wrong.colors.pop_back();
    EXPECT_EQ(kindOf("mesh.ply", wrong), ErrorKind::Usage);
    EXPECT_TRUE(fs::is_empty(mFolder));
}

TEST_F(MeshFiles, FullDiskIsAnError) {
    for (const std::string& extension : writableMeshExtensions()) {
        const fs::path path = mFolder / ("full" + extension);
        fs::create_symlink("/dev/full", path);
        try {
            writeMesh(path, octahedron());
            FAIL() << "expected an error: " << extension;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Runtime);
            EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace bandvox::mesh_test

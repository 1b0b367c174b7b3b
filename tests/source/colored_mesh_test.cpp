#include "source/colored_files.h"
#include "source/mesh_files.h"
#include "source/srgb.h"
#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/colored_mesh.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Vec2d;
using openvdb::Vec3f;
using test::TemporaryFolder;

Vec3f linearOf(int r, int g, int b) {
    const auto channel = [](int value) { return static_cast<float>(linearOfSrgb(value / 255.0)); };
    return {channel(r), channel(g), channel(b)};
}

void expectColor(const Vec3f& color, const Vec3f& expected) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], expected[k], 2e-5) << k;
}

/// The colour of a triangle at one of its corners.
Vec3f colorAt(const ColoredMesh& mesh, std::size_t triangle, int corner) {
    const TrianglePaint& paint = mesh.paints.at(triangle);
    if (paint.texture < 0) return paint.color[corner];
    const MeshTexture& texture = mesh.textures.at(paint.texture);
    return paint.color[corner] * texture.picture->sample(Vec2d(paint.uv[corner]), texture.wraps, 0);
}

/// The message of the error that reading gives.
std::string refusal(const fs::path& path) {
    try {
        readColoredMesh(path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        return error.what();
    }
    return "";
}

bool warnsOf(const ColoredMeshFile& file, const std::string& text) {
    return std::any_of(file.warnings.begin(), file.warnings.end(),
                       [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

std::string readAll(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// The buffer of coloredGltf for a triangle with colours.
std::string gltfBuffer() {
    std::string bytes;
    for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F,  0.F, 0.F, 1.F, 0.F,  // places
                              0.F, 0.F, 1.F, 0.F, 0.F,  1.F,                 // texture coordinates
                              1.F, 0.F, 0.F, 0.F, 0.5F, 0.F, 0.F, 0.F, 0.25F}) {
        bytes += test::bytesOf(value);
    }
    return test::base64(bytes);
}

// --- colours of points --------------------------------------------------------------------------

TEST(ColoredMesh, PlyColorsAreSrgb) {
    const TemporaryFolder folder;
    const fs::path path = folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 188 0\n0 1 "
        "0 10 20 30\n3 0 1 2\n");
    const ColoredMeshFile file = readColoredMesh(path);
    EXPECT_EQ(file.triangles, 1u);
    EXPECT_EQ(file.colored.name, "a.ply");
    expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
    expectColor(colorAt(file.colored, 0, 1), linearOf(0, 188, 0));
    expectColor(colorAt(file.colored, 0, 2), linearOf(10, 20, 30));
    EXPECT_NEAR(colorAt(file.colored, 0, 1)[1], 0.5, 5e-3);
}

TEST(ColoredMesh, ObjPointsHaveColorsBehindTheirPlaces) {
    const TemporaryFolder folder;
    const fs::path path =
        folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0.5 0.5 1\nf 1 2 3\n");
    const ColoredMeshFile file = readColoredMesh(path);
    expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
    expectColor(colorAt(file.colored, 0, 1), Vec3f(0, 1, 0));
    EXPECT_NEAR(colorAt(file.colored, 0, 2)[0], linearOfSrgb(0.5), 1e-5);
    // Some programs count to 255 there.
    const fs::path bytes =
        folder.write("b.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 10 20 255\nf 1 2 3\n");
    expectColor(colorAt(readColoredMesh(bytes).colored, 0, 2), linearOf(10, 20, 255));
    // A little above 1 is 1.
    const fs::path above =
        folder.write("c.obj", "v 0 0 0 1.0001 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0.5 0.5 1\nf 1 2 3\n");
    expectColor(colorAt(readColoredMesh(above).colored, 0, 0), Vec3f(1, 0, 0));
}

TEST(ColoredMesh, GltfColorsAreLinearAndMultiply) {
    const TemporaryFolder folder;
    const fs::path plain =
        folder.write("a.gltf", test::coloredGltf(R"(,"COLOR_0":2)", "", gltfBuffer()));
    const ColoredMeshFile file = readColoredMesh(plain);
    expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
    expectColor(colorAt(file.colored, 0, 1), Vec3f(0, 0.5F, 0));
    expectColor(colorAt(file.colored, 0, 2), Vec3f(0, 0, 0.25F));
    std::string text = test::coloredGltf(
        R"(,"COLOR_0":2)",
        R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1]}}])",
        gltfBuffer());
    text.replace(text.find("}}]}]"), 5, R"(},"material":0}]}])");
    expectColor(colorAt(readColoredMesh(folder.write("b.gltf", text)).colored, 0, 1),
                Vec3f(0, 0.25F, 0));
}

// --- materials and textures ---------------------------------------------------------------------

TEST(ColoredMesh, ObjMaterialsGiveTheirTrianglesColors) {
    const TemporaryFolder folder;
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.6 0.6 0.6\n");
    const fs::path path = folder.write("a.obj",
                                       "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl "
                                       "red\nf 1 2 3\nusemtl grey\nf 1 2 4\n");
    const ColoredMeshFile file = readColoredMesh(path);
    EXPECT_EQ(file.triangles, 2u);
    ASSERT_EQ(file.colored.paints.size(), file.colored.mesh.triangles.size());
    expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
    expectColor(colorAt(file.colored, 1, 0), Vec3f(static_cast<float>(linearOfSrgb(0.6))));
}

TEST(ColoredMesh, ObjTextureIsReadBesideIt) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 2, 2, 3,
                       {255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188});
    folder.write("skin.mtl", "newmtl skin\nmap_Kd skin.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
    EXPECT_TRUE(file.warnings.empty());
    ASSERT_EQ(file.colored.textures.size(), 1u);
    const Texture& picture = *file.colored.textures[0].picture;
    // The first row is the upper one.
    expectColor(picture.sample(Vec2d(0.25, 0.75), {}, 0), Vec3f(1, 0, 0));
    expectColor(picture.sample(Vec2d(0.75, 0.75), {}, 0), Vec3f(0, 1, 0));
    expectColor(picture.sample(Vec2d(0.25, 0.25), {}, 0), Vec3f(0, 0, 1));
    expectColor(picture.sample(Vec2d(0.75, 0.25), {}, 0), linearOf(188, 188, 188));
    for (std::size_t t = 0; t < 2; ++t) {
        const openvdb::Vec3I& corners = file.colored.mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3d& p = file.colored.mesh.points[corners[k]];
            EXPECT_EQ(file.colored.paints[t].uv[k], openvdb::Vec2f(p.x(), p.y()));
        }
    }
}

TEST(ColoredMesh, ObjColorIsAFactorOfItsTexture) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {255, 188, 0});
    folder.write("skin.mtl", "newmtl skin\nKd 1 0.5 1\nmap_Kd -clamp on skin.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
    EXPECT_EQ(file.colored.textures.at(0).wraps.u, TextureWrap::Clamp);
    EXPECT_NEAR(colorAt(file.colored, 0, 0)[1], linearOfSrgb(0.5) * linearOfSrgb(188 / 255.0),
                2e-5);
}

TEST(ColoredMesh, AlphaIsLeftOut) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 4, {200, 100, 50, 10});
    folder.write("skin.mtl", "newmtl skin\nmap_Kd skin.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
    expectColor(colorAt(file.colored, 0, 0), linearOf(200, 100, 50));
}

TEST(ColoredMesh, GreyPicturesHaveThreeChannelsToo) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 2, 1, 1, {100, 100});
    folder.write("skin.mtl", "newmtl skin\nmap_Kd skin.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
    expectColor(colorAt(file.colored, 0, 0), linearOf(100, 100, 100));
}

TEST(ColoredMesh, NamesOfTexturesMayBeOfOtherMachines) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "maps");
    test::writePicture(folder.path() / "maps/the skin.png", 1, 1, 3, {9, 99, 199});
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {9, 99, 199});
    for (const char* name : {"maps\\the skin.png", "maps/the%20skin.png", "C:\\art\\skin.png",
                             "/nowhere/at/all/skin.png"}) {
        folder.write("skin.mtl", std::string("newmtl skin\nmap_Kd ") + name + "\n");
        const ColoredMeshFile file =
            readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
        EXPECT_TRUE(file.warnings.empty()) << name;
        expectColor(colorAt(file.colored, 0, 0), linearOf(9, 99, 199));
    }
}

TEST(ColoredMesh, GltfTextureMayBePartOfTheFile) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {188, 255, 0});
    const std::string picture = test::base64(readAll(folder.path() / "skin.png"));
    for (const std::string& image : {"data:image/png;base64," + picture, std::string("skin.png")}) {
        std::string text = test::coloredGltf(
            R"(,"TEXCOORD_0":1)",
            R"(,"materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],)"
            R"("baseColorTexture":{"index":0}}}],"textures":[{"source":0,"sampler":0}],)"
            R"("samplers":[{"wrapS":33648,"wrapT":33071}],"images":[{"uri":")" +
                image + "\"}]",
            gltfBuffer());
        text.replace(text.find("}}]}]"), 5, R"(},"material":0}]}])");
        const ColoredMeshFile file = readColoredMesh(folder.write("a.gltf", text));
        EXPECT_TRUE(file.warnings.empty()) << file.warnings.at(0);
        expectColor(colorAt(file.colored, 0, 1), linearOf(188, 255, 0) * 0.5F);
        EXPECT_EQ(file.colored.textures.at(0).wraps.u, TextureWrap::Mirror);
        EXPECT_EQ(file.colored.textures.at(0).wraps.v, TextureWrap::Clamp);
        // From the lower left: glTF counts from the upper left.
        EXPECT_EQ(file.colored.paints[0].uv[2], openvdb::Vec2f(0, 0));
    }
}

TEST(ColoredMesh, GltfMayTransformTextureCoordinates) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {1, 2, 3});
    std::string text = test::coloredGltf(
        R"(,"TEXCOORD_0":1)",
        R"(,"extensionsUsed":["KHR_texture_transform"],"materials":[{"name":"m",)"
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
        R"({"KHR_texture_transform":{"offset":[0.125,0.25],"rotation":0.5,"scale":[2,3]}}}}}],)"
        R"("textures":[{"source":0}],"images":[{"uri":"skin.png"}])",
        gltfBuffer());
    text.replace(text.find("}}]}]"), 5, R"(},"material":0}]}])");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.gltf", text));
    // The extension: scale, then turn, then offset, v downward.
    const auto expected = [](double u, double v) {
        const double c = std::cos(0.5), s = std::sin(0.5);
        return Vec2d(c * 2 * u + s * 3 * v + 0.125, 1 - (-s * 2 * u + c * 3 * v + 0.25));
    };
    const Vec2d given[] = {{0, 0}, {1, 0}, {0, 1}};
    for (int k = 0; k < 3; ++k) {
        const Vec2d uv = expected(given[k].x(), given[k].y());
        EXPECT_NEAR(file.colored.paints[0].uv[k].x(), uv.x(), 1e-5) << k;
        EXPECT_NEAR(file.colored.paints[0].uv[k].y(), uv.y(), 1e-5) << k;
    }
}

// What the importer's own exporter makes of a textured square and a plain one.
TEST(ColoredMesh, OtherFormatsSayTheSame) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {20, 188, 255});
    folder.write("skin.mtl",
                 "newmtl skin\nKd 1 1 1\nmap_Kd skin.png\nnewmtl red\nKd 0.9 0.1 0.1\n");
    const fs::path obj = folder.write("a.obj", test::texturedSquareObj() +
                                                   "v 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl red\n"
                                                   "f 5/1 6/2 7/3\n");
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(obj.string(), aiProcess_Triangulate);
    ASSERT_NE(scene, nullptr);
    for (const auto& [format, name] :
         {std::pair("collada", "b.dae"), {"fbxa", "b.fbx"}, {"glb2", "b.glb"}}) {
        Assimp::Exporter exporter;
        ASSERT_EQ(exporter.Export(scene, format, (folder.path() / name).string()), AI_SUCCESS);
        const ColoredMeshFile file = readColoredMesh(folder.path() / name);
        ASSERT_EQ(file.triangles, 3u) << format;
        EXPECT_TRUE(file.warnings.empty()) << format << " " << file.warnings[0];
        SCOPED_TRACE(format);
        expectColor(colorAt(file.colored, 0, 0), linearOf(20, 188, 255));
        // Numbers are kept as they are, and glTF takes them for linear.
        const bool isGltf = std::string(format) == "glb2";
        const Vec3f red = isGltf ? Vec3f(0.9F, 0.1F, 0.1F)
                                 : Vec3f(static_cast<float>(linearOfSrgb(0.9)),
                                         static_cast<float>(linearOfSrgb(0.1)),
                                         static_cast<float>(linearOfSrgb(0.1)));
        expectColor(colorAt(file.colored, 2, 0), red);
    }
}

// --- what is wrong with it ----------------------------------------------------------------------

TEST(ColoredMesh, MissingTextureIsAWarningThatNamesIt) {
    const TemporaryFolder folder;
    folder.write("skin.mtl", "newmtl skin\nKd 1 0 0\nmap_Kd none.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.obj", test::texturedSquareObj()));
    EXPECT_EQ(file.warnings.size(), 1u);
    EXPECT_TRUE(warnsOf(file, "none.png\" does not exist"));
    expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
}

TEST(ColoredMesh, DamagedTextureIsAWarningThatNamesIt) {
    const TemporaryFolder folder;
    folder.write("skin.mtl", "newmtl skin\nKd 1 0 0\nmap_Kd skin.png\n");
    const fs::path path = folder.write("a.obj", test::texturedSquareObj());
    test::writePicture(folder.path() / "skin.png", 64, 64, 3,
                       std::vector<std::uint8_t>(3 * 64 * 64, 77));
    const std::string whole = readAll(folder.path() / "skin.png");
    for (const std::string& bytes : {std::string(), std::string("no picture"), whole.substr(0, 20),
                                     whole.substr(0, whole.size() / 2)}) {
        folder.write("skin.png", bytes);
        const ColoredMeshFile file = readColoredMesh(path);
        EXPECT_EQ(file.warnings.size(), 1u) << bytes.size();
        EXPECT_TRUE(warnsOf(file, "skin.png\" cannot be read")) << bytes.size();
        expectColor(colorAt(file.colored, 0, 0), Vec3f(1, 0, 0));
    }
    fs::remove(folder.path() / "skin.png");
    fs::create_directory(folder.path() / "skin.png");
    EXPECT_TRUE(warnsOf(readColoredMesh(path), "not a regular file"));
}

TEST(ColoredMesh, TextureNeedsCoordinates) {
    const TemporaryFolder folder;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {1, 2, 3});
    folder.write("skin.mtl", "newmtl skin\nKd 0 1 0\nmap_Kd skin.png\n");
    const ColoredMeshFile file = readColoredMesh(folder.write(
        "a.obj", "mtllib skin.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\n"));
    EXPECT_TRUE(warnsOf(file, "no texture coordinates"));
}

TEST(ColoredMesh, RefusesWhatIsNotFinite) {
    const TemporaryFolder folder;
    const std::string nan = test::bytesOf(std::numeric_limits<float>::quiet_NaN());
    std::string buffer;
    for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
        buffer += test::bytesOf(value);
    }
    for (int i = 0; i < 15; ++i) buffer += nan;
    test::writePicture(folder.path() / "skin.png", 1, 1, 3, {1, 2, 3});
    EXPECT_NE(refusal(folder.write("a.gltf",
                                   test::coloredGltf(R"(,"COLOR_0":2)", "", test::base64(buffer))))
                  .find("a colour that is not finite"),
              std::string::npos);
    std::string text = test::coloredGltf(
        R"(,"TEXCOORD_0":1)",
        R"(,"materials":[{"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
        R"("textures":[{"source":0}],"images":[{"uri":"skin.png"}])",
        test::base64(buffer));
    text.replace(text.find("}}]}]"), 5, R"(},"material":0}]}])");
    EXPECT_NE(refusal(folder.write("b.gltf", text)).find("a texture coordinate that is not finite"),
              std::string::npos);
}

TEST(ColoredMesh, RefusesMeshesWithoutColors) {
    const TemporaryFolder folder;
    const Mesh cube = test::cube(openvdb::Vec3d(0), 1);
    for (const auto& [name, bytes] :
         {std::pair<std::string, std::string>("a.obj", test::objText(cube)),
          {"b.ply", test::plyText(cube)},
          {"c.stl", test::stlBinary(cube)},
          {"d.off", test::offText(cube)},
          {"e.glb", test::glb(cube, R"({"mesh":0})", 1)},
          {"f.obj", test::texturedSquareObj("mtllib missing.mtl\n")}}) {
        EXPECT_NE(refusal(folder.write(name, bytes)).find("has no colours"), std::string::npos)
            << name;
    }
    EXPECT_NE(refusal(folder.path() / "none.obj").find("does not exist"), std::string::npos);
}

TEST(ColoredMesh, TellsOfTrianglesWithoutColor) {
    const TemporaryFolder folder;
    std::string text = test::coloredGltf(
        "", R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}])",
        gltfBuffer());
    text.replace(text.find("}}]}]"), 5, R"(},"material":0},{"attributes":{"POSITION":0}}]}])");
    const ColoredMeshFile file = readColoredMesh(folder.write("a.gltf", text));
    EXPECT_EQ(file.triangles, 1u);
    EXPECT_EQ(file.colored.paints.size(), 2u);
    EXPECT_TRUE(warnsOf(file, "1 of 2 triangles have no colour"));
}

}  // namespace
}  // namespace bandvox

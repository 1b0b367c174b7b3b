#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

// Writers of meshes with colours, for tests that read them.
namespace bandvox::test {

/// Writes a picture of 8-bit values, of the kind that its name ends in; rows from the top.
inline void writePicture(const std::filesystem::path& path, int width, int height, int channels,
                         const std::vector<std::uint8_t>& values) {
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output);
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(output->open(path.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, values.data()));
    ASSERT_TRUE(output->close());
}

/// A square [0, 1]² of z = 0, with texture coordinates that are its own, as `usemtl skin`.
inline std::string texturedSquareObj(const std::string& before = "mtllib skin.mtl\n") {
    return before +
           "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
           "usemtl skin\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
}

/// A triangle as glTF with attributes and materials of its own; `attributes` and `rest` go into the
/// JSON as they are. The buffer: three points, three texture coordinates, three colours of three
/// floats, with accessors 0, 1, 2.
inline std::string coloredGltf(const std::string& attributes, const std::string& rest,
                               const std::string& encodedBuffer) {
    std::ostringstream text;
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
         << R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0)"
         << attributes << R"(}}]}],"buffers":[{"byteLength":96,"uri":")"
         << "data:application/octet-stream;base64," << encodedBuffer << R"("}],"bufferViews":[)"
         << R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},)"
         << R"({"buffer":0,"byteOffset":60,"byteLength":36}],"accessors":[)"
         << R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         << R"("min":[0,0,0],"max":[1,1,0]},)"
         << R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},)"
         << R"({"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"}])" << rest << "}";
    return text.str();
}

}  // namespace bandvox::test

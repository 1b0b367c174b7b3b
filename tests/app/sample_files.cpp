#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/cexport.h>
#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace bandvox::app_test {
namespace {

using Corner = std::array<float, 3>;
using Triangle = std::array<unsigned, 3>;

constexpr std::array<Corner, 8> kCorners{{{-1, -1, -1},
                                          {1, -1, -1},
                                          {1, 1, -1},
                                          {-1, 1, -1},
                                          {-1, -1, 1},
                                          {1, -1, 1},
                                          {1, 1, 1},
                                          {-1, 1, 1}}};
// Corners of each side, counter-clockwise from outside; the last one is z = 1.
constexpr std::array<std::array<unsigned, 4>, 6> kSides{
    {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}};

std::vector<Triangle> triangles() {
    std::vector<Triangle> all;
    for (const auto& side : kSides) {
        all.push_back({side[0], side[1], side[2]});
        all.push_back({side[0], side[2], side[3]});
    }
    return all;
}

std::string obj(std::size_t sides) {
    std::ostringstream text;
    for (const Corner& c : kCorners) text << "v " << c[0] << ' ' << c[1] << ' ' << c[2] << '\n';
    for (std::size_t i = 0; i < sides; ++i) {
        text << 'f';
        for (const unsigned corner : kSides[i]) text << ' ' << corner + 1;
        text << '\n';
    }
    return text.str();
}

template <typename T>
void append(std::string& bytes, const T& value) {
    const std::size_t size = bytes.size();
    bytes.resize(size + sizeof(T));
    std::memcpy(bytes.data() + size, &value, sizeof(T));
}

}  // namespace

std::string cubeObj() {
    return obj(kSides.size());
}

std::string openCubeObj() {
    return obj(kSides.size() - 1);
}

std::string coloredCubeObj() {
    std::istringstream lines(cubeObj());
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("v ")) line += line.ends_with("-1") ? " 1 0 0" : " 0 0 1";
        text += line + "\n";
    }
    return text;
}

std::string cubePly() {
    std::ostringstream text;
    text << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
            "property float z\nelement face 12\nproperty list uchar int vertex_indices\n"
            "end_header\n";
    for (const Corner& c : kCorners) text << c[0] << ' ' << c[1] << ' ' << c[2] << '\n';
    for (const Triangle& t : triangles()) {
        text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }
    return text.str();
}

std::string cubeStlAscii() {
    std::ostringstream text;
    text << "solid cube\n";
    for (const Triangle& t : triangles()) {
        text << "facet normal 0 0 0\n outer loop\n";
        for (const unsigned i : t) {
            const Corner& c = kCorners[i];
            text << "  vertex " << c[0] << ' ' << c[1] << ' ' << c[2] << '\n';
        }
        text << " endloop\nendfacet\n";
    }
    text << "endsolid cube\n";
    return text.str();
}

std::string cubeStlBinary() {
    std::string bytes(80, ' ');
    append(bytes, static_cast<std::uint32_t>(triangles().size()));
    for (const Triangle& t : triangles()) {
        append(bytes, Corner{0, 0, 0});
        for (const unsigned i : t) append(bytes, kCorners[i]);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string cubeGlb() {
    std::string buffer;
    for (const Corner& c : kCorners) append(buffer, c);
    for (const Triangle& t : triangles()) {
        for (const unsigned i : t) append(buffer, static_cast<std::uint16_t>(i));
    }
    std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
                       R"("nodes":[{"mesh":0}],)"
                       R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
                       R"("buffers":[{"byteLength":168}],"bufferViews":[)"
                       R"({"buffer":0,"byteOffset":0,"byteLength":96},)"
                       R"({"buffer":0,"byteOffset":96,"byteLength":72}],"accessors":[)"
                       R"({"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)"
                       R"("min":[-1,-1,-1],"max":[1,1,1]},)"
                       R"({"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})";
    while (json.size() % 4 != 0) json += ' ';

    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
    append(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    append(bytes, static_cast<std::uint32_t>(buffer.size()));
    bytes += std::string("BIN\0", 4) + buffer;
    return bytes;
}

std::string exportedCube(const std::string& format) {
    const std::string text = cubeObj();
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, "obj");
    Assimp::Exporter exporter;
    const aiExportDataBlob* blob = scene ? exporter.ExportToBlob(scene, format) : nullptr;
    if (blob == nullptr) throw std::runtime_error("cannot export to " + format);
    return {static_cast<const char*>(blob->data), blob->size};
}

void writeSeveralGrids(const std::filesystem::path& path) {
    openvdb::GridCPtrVec grids;
    for (const char* name : {"heat", "density"}) {
        auto grid = openvdb::FloatGrid::create(0);
        grid->setName(name);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
        grid->tree().setValue({1, 2, 3}, 1.0f);
        grids.push_back(grid);
    }
    auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("vel");
    velocity->tree().setValue({0, 0, 0}, {1, 2, 3});
    velocity->insertMeta("note", openvdb::StringMetadata("two\nlines, and a byte: \xff"));
    grids.push_back(velocity);
    auto mask = openvdb::BoolGrid::create(false);
    mask->setName("mask");
    grids.push_back(mask);
    writeVdb(path, grids);
}

void writeOddlyNamedGrid(const std::filesystem::path& path) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->setName("two\nlines\x1b[31m");
    grid->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), 1.0f);
    writeVdb(path, {grid});
}

}  // namespace bandvox::app_test

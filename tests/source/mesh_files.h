#pragma once

#include <bandvox/source/mesh.h>

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

// Writers of mesh files, for tests that read them.
namespace bandvox::test {

/// A folder that is removed with all in it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string pattern = (std::filesystem::temp_directory_path() /
                               (std::string("bandvox_") + test->name() + "_XXXXXX"))
                                  .string();
        mPath = ::mkdtemp(pattern.data());
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(mPath, ignored);
    }

    const std::filesystem::path& path() const { return mPath; }

    /// Writes a file and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(mPath / name, std::ios::binary) << bytes;
        return mPath / name;
    }

  private:
    std::filesystem::path mPath;
};

template <typename T>
std::string bytesOf(T value, bool bigEndian = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bigEndian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::string objText(const Mesh& mesh) {
    std::ostringstream text;
    for (const auto& p : mesh.points) {
        text << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
    }
    for (const auto& t : mesh.triangles) {
        text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    }
    return text.str();
}

inline std::string offText(const Mesh& mesh) {
    std::ostringstream text;
    text << "OFF\n# made by a test\n"
         << mesh.points.size() << " " << mesh.triangles.size() << " 0\n";
    for (const auto& p : mesh.points) text << p.x() << " " << p.y() << " " << p.z() << "\n";
    for (const auto& t : mesh.triangles) {
        text << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    }
    return text.str();
}

inline std::string stlText(const Mesh& mesh) {
    std::ostringstream text;
    text << "solid test\n";
    for (const auto& t : mesh.triangles) {
        text << "facet normal 0 0 0\n outer loop\n";
        for (int k = 0; k < 3; ++k) {
            const auto& p = mesh.points[t[k]];
            text << "  vertex " << p.x() << " " << p.y() << " " << p.z() << "\n";
        }
        text << " endloop\nendfacet\n";
    }
    text << "endsolid test\n";
    return text.str();
}

inline std::string stlBinary(const Mesh& mesh, const std::string& header = "binary") {
    std::string bytes = header;
    bytes.resize(80, ' ');
    bytes += bytesOf(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        bytes += std::string(12, '\0');
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                bytes += bytesOf(static_cast<float>(mesh.points[t[k]][axis]));
            }
        }
        bytes += std::string(2, '\0');
    }
    return bytes;
}

inline std::string plyHeader(const Mesh& mesh, const std::string& format) {
    return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
           std::to_string(mesh.points.size()) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string plyText(const Mesh& mesh) {
    std::string text = offText(mesh);
    for (int line = 0; line < 3; ++line) text.erase(0, text.find('\n') + 1);
    return plyHeader(mesh, "ascii") + text;
}

inline std::string plyBinary(const Mesh& mesh, bool bigEndian) {
    std::string bytes = plyHeader(mesh, bigEndian ? "binary_big_endian" : "binary_little_endian");
    for (const auto& p : mesh.points) {
        for (int k = 0; k < 3; ++k) bytes += bytesOf(static_cast<float>(p[k]), bigEndian);
    }
    for (const auto& t : mesh.triangles) {
        bytes += '\3';
        for (int k = 0; k < 3; ++k) bytes += bytesOf(static_cast<std::int32_t>(t[k]), bigEndian);
    }
    return bytes;
}

/// The buffer of a glTF file: indices, then points.
inline std::string gltfBuffer(const Mesh& mesh) {
    std::string bytes;
    for (const auto& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) bytes += bytesOf(static_cast<std::uint32_t>(t[k]));
    }
    for (const auto& p : mesh.points) {
        for (int k = 0; k < 3; ++k) bytes += bytesOf(static_cast<float>(p[k]));
    }
    return bytes;
}

inline std::string base64(const std::string& bytes) {
    static const char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const char c = i + k < bytes.size() ? bytes[i + k] : '\0';
            group = group << 8 | static_cast<unsigned char>(c);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

/// The JSON of a glTF file whose one mesh is placed by `nodes`, all of them in the scene.
inline std::string gltfText(const Mesh& mesh, const std::string& nodes, int nodeCount,
                            const std::string& uri) {
    const std::size_t indexBytes = 12 * mesh.triangles.size();
    const std::size_t pointBytes = 12 * mesh.points.size();
    std::string sceneNodes;
    for (int i = 0; i < nodeCount; ++i) {
        if (i > 0) sceneNodes += ',';
        sceneNodes += std::to_string(i);
    }
    std::ostringstream text;
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" << sceneNodes
         << R"(]}],"nodes":[)" << nodes
         << R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
         << R"("buffers":[{"byteLength":)" << indexBytes + pointBytes << uri << R"(}],)"
         << R"("bufferViews":[{"buffer":0,"byteLength":)" << indexBytes
         << R"(},{"buffer":0,"byteOffset":)" << indexBytes << R"(,"byteLength":)" << pointBytes
         << R"(}],"accessors":[{"bufferView":0,"componentType":5125,"count":)"
         << 3 * mesh.triangles.size()
         << R"(,"type":"SCALAR"},{"bufferView":1,"componentType":5126,"count":)"
         << mesh.points.size() << R"(,"type":"VEC3","min":[-9,-9,-9],"max":[9,9,9]}]})";
    return text.str();
}

inline std::string embeddedGltf(const Mesh& mesh, const std::string& nodes, int nodeCount) {
    return gltfText(
        mesh, nodes, nodeCount,
        R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltfBuffer(mesh)) + "\"");
}

inline std::string glb(const Mesh& mesh, const std::string& nodes, int nodeCount) {
    std::string json = gltfText(mesh, nodes, nodeCount, "");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string buffer = gltfBuffer(mesh);
    const auto size32 = [](std::size_t size) { return bytesOf(static_cast<std::uint32_t>(size)); };
    return "glTF" + size32(2) + size32(28 + json.size() + buffer.size()) + size32(json.size()) +
           "JSON" + json + size32(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

}  // namespace bandvox::test

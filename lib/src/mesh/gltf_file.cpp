#include "core/words.h"
#include "mesh/mesh_formats.h"
#include "mesh/mesh_notes.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>

// glTF 2.0, Khronos Group (2021): one mesh of one primitive, in a single file.
namespace bandvox {

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace {

// What accessors are of.
constexpr int kFloats = 5126;
constexpr int kUnsigned = 5125;
// What parts of a buffer are for.
constexpr int kOfPoints = 34962;
constexpr int kOfIndices = 34963;

constexpr std::size_t kVectorBytes = 3 * sizeof(float);

// Points are stored relative to this.
Vec3d originOf(const WritableMesh& mesh) {
    return mesh.needsDouble ? mesh.box.getCenter() : Vec3d(0.0);
}

// Behind one another: points, normals, colours, corners.
std::size_t bufferBytes(const WritableMesh& mesh) {
    const std::size_t perPoint = (mesh.hasColors() ? 3 : 2) * kVectorBytes;
    return perPoint * mesh.surface.mesh.points.size() +
           kVectorBytes * mesh.surface.mesh.triangles.size();
}

template <typename Number>
std::string exactText(const openvdb::math::Vec3<Number>& vector) {
    std::string text = "[";
    for (int k = 0; k < 3; ++k) {
        char number[32];
        const auto end = std::to_chars(number, number + sizeof number, vector[k]).ptr;
        text.append(k > 0 ? "," : "").append(number, end);
    }
    return text + "]";
}

class GltfText {
  public:
    explicit GltfText(const WritableMesh& mesh) : mMesh(mesh) {}

    // `uri`: of the buffer, or empty for that of the file itself. Comes in two parts, between which
    // the buffer's text can be put.
    std::pair<std::string, std::string> make(const std::string& uri);

  private:
    void addVectors(const std::string& limits) {
        const std::size_t count = mMesh.surface.mesh.points.size();
        addAccessor(count, kFloats, "VEC3", limits);
        addView(count * kVectorBytes, kOfPoints);
    }

    void addAccessor(std::size_t count, int type, const std::string& shape,
                     const std::string& limits) {
        mAccessors += mAccessors.empty() ? "" : ",";
        mAccessors += R"({"bufferView":)" + std::to_string(mViewCount) + R"(,"componentType":)" +
                      std::to_string(type) + R"(,"count":)" + std::to_string(count) +
                      R"(,"type":")" + shape + "\"" + limits + "}";
    }

    void addView(std::size_t bytes, int target) {
        mViews += mViews.empty() ? "" : ",";
        mViews += R"({"buffer":0,"byteOffset":)" + std::to_string(mOffset) + R"(,"byteLength":)" +
                  std::to_string(bytes) + R"(,"target":)" + std::to_string(target) + "}";
        mOffset += bytes;
        ++mViewCount;
    }

    const WritableMesh& mMesh;
    std::string mAccessors, mViews;
    std::size_t mOffset = 0;
    int mViewCount = 0;
};

std::pair<std::string, std::string> GltfText::make(const std::string& uri) {
    const Vec3d origin = originOf(mMesh);
    const Vec3f low(mMesh.box.min() - origin), high(mMesh.box.max() - origin);
    addVectors(R"(,"min":)" + exactText(low) + R"(,"max":)" + exactText(high));
    addVectors("");
    if (mMesh.hasColors()) addVectors("");
    const int corners = mViewCount;
    const std::size_t triangles = mMesh.surface.mesh.triangles.size();
    addAccessor(3 * triangles, kUnsigned, "SCALAR", "");
    addView(kVectorBytes * triangles, kOfIndices);

    std::string head = std::string(R"({"asset":{"version":"2.0","generator":"Bandvox )") +
                       version() + '"' + gltfNotes(mMesh.notes) +
                       R"(},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)";
    if (mMesh.needsDouble) head += R"(,"translation":)" + exactText(origin);
    head += R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1)";
    if (mMesh.hasColors()) head += R"(,"COLOR_0":2)";
    // Without a material a surface is a metal's, and reflects what most viewers do not have.
    head += R"(},"indices":)" + std::to_string(corners) +
            R"(,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"metallicFactor":0,)"
            R"("roughnessFactor":0.7}}],"accessors":[)" +
            mAccessors + R"(],"bufferViews":[)" + mViews + R"(],"buffers":[{"byteLength":)" +
            std::to_string(mOffset);
    if (uri.empty()) return {head, "}]}"};
    return {head + R"(,"uri":")" + uri, "\"}]}\n"};
}

template <typename Output>
void writeBuffer(Output& output, const WritableMesh& mesh) {
    const auto putVector = [&](const Vec3f& v) {
        for (int k = 0; k < 3; ++k) output.put(v[k]);
    };
    const Vec3d origin = originOf(mesh);
    for (const Vec3d& point : mesh.surface.mesh.points) putVector(Vec3f(point - origin));
    for (const Vec3f& normal : mesh.surface.normals) putVector(normal);
    for (const Vec3f& color : mesh.surface.colors) {
        for (int c = 0; c < 3; ++c) output.put(std::clamp(color[c], 0.0F, 1.0F));
    }
    for (const openvdb::Vec3I& triangle : mesh.surface.mesh.triangles) {
        for (int k = 0; k < 3; ++k) output.put(triangle[k]);
    }
}

}  // namespace

void writeGlb(ByteOutput& output, const WritableMesh& mesh) {
    constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
    constexpr std::size_t kHeads = 12 + 8 + 8;
    auto [text, end] = GltfText(mesh).make("");
    text += end;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t bytes = bufferBytes(mesh);
    const std::size_t total = kHeads + text.size() + bytes;
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (total > kMost) {
        throw Error(ErrorKind::Result, "a .glb of this mesh would have " + std::to_string(total) +
                                           " bytes; the format holds up to " +
                                           std::to_string(kMost) + ", a .ply more");
    }
    output.put(kMagic);
    output.put(std::uint32_t(2));
    output.put(static_cast<std::uint32_t>(total));
    output.put(static_cast<std::uint32_t>(text.size()));
    output.put(kJson);
    output.put(text);
    output.put(static_cast<std::uint32_t>(bytes));
    output.put(kBinary);
    writeBuffer(output, mesh);
}

void writeGltf(ByteOutput& output, const WritableMesh& mesh) {
    const auto [text, end] = GltfText(mesh).make("data:application/octet-stream;base64,");
    output.put(text);
    Base64Output coded(output);
    writeBuffer(coded, mesh);
    coded.close();
    output.put(end);
}

}  // namespace bandvox

#include "mesh/mesh_formats.h"

#include "mesh/mesh_notes.h"
#include "source/srgb.h"

#include <bandvox/core/version.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace bandvox {

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace {

std::array<std::uint8_t, 3> srgbBytes(const Vec3f& color) {
    std::array<std::uint8_t, 3> bytes;
    for (int c = 0; c < 3; ++c) {
        bytes[c] = static_cast<std::uint8_t>(std::lround(255 * srgbOfLinear(color[c])));
    }
    return bytes;
}

std::string signature() {
    return std::string("Bandvox ") + version();
}

// Of the rounded corners; a reader makes it of the same.
Vec3f facetNormal(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3d normal = (Vec3d(b) - Vec3d(a)).cross(Vec3d(c) - Vec3d(a));
    const double length = normal.length();
    return length > 0 ? Vec3f(normal / length) : Vec3f(0.0F);
}

template <typename Number, typename Vector>
void putNumbers(ByteOutput& output, const Vector& vector) {
    for (int k = 0; k < 3; ++k) {
        output.put(' ');
        output.putText(static_cast<Number>(vector[k]));
    }
}

}  // namespace

void writePly(ByteOutput& output, const WritableMesh& mesh) {
    const std::string number = mesh.needsDouble ? "double" : "float";
    std::string head = "ply\nformat binary_little_endian 1.0\ncomment " + signature();
    for (const std::string& note : mesh.notes) head += kPlyNote + note;
    head += "\nelement vertex " + std::to_string(mesh.surface.mesh.points.size()) + "\n";
    for (const char* name : {"x", "y", "z"})
        head.append("property ").append(number).append(" ").append(name).append("\n");
    for (const char* name : {"nx", "ny", "nz"})
        head.append("property float ").append(name).append("\n");
    if (mesh.hasColors()) {
        for (const char* name : {"red", "green", "blue"})
            head.append("property uchar ").append(name).append("\n");
    }
    head += "element face " + std::to_string(mesh.surface.mesh.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
    output.put(head);
    for (std::size_t i = 0; i < mesh.surface.mesh.points.size(); ++i) {
        const Vec3d& point = mesh.surface.mesh.points[i];
        for (int k = 0; k < 3; ++k) {
            if (mesh.needsDouble) {
                output.put(point[k]);
            } else {
                output.put(static_cast<float>(point[k]));
            }
        }
        for (int k = 0; k < 3; ++k) output.put(mesh.surface.normals[i][k]);
        if (!mesh.hasColors()) continue;
        for (const std::uint8_t byte : srgbBytes(mesh.surface.colors[i])) {
            output.put(static_cast<char>(byte));
        }
    }
    for (const openvdb::Vec3I& triangle : mesh.surface.mesh.triangles) {
        output.put(char(3));
        for (int k = 0; k < 3; ++k) output.put(triangle[k]);
    }
}

void writeObj(ByteOutput& output, const WritableMesh& mesh) {
    output.put("# " + signature());
    for (const std::string& note : mesh.notes) output.put(kObjNote + note);
    output.put('\n');
    for (std::size_t i = 0; i < mesh.surface.mesh.points.size(); ++i) {
        output.put('v');
        const Vec3d& point = mesh.surface.mesh.points[i];
        if (mesh.needsDouble) {
            putNumbers<double>(output, point);
        } else {
            putNumbers<float>(output, point);
        }
        if (mesh.hasColors()) {
            for (const std::uint8_t byte : srgbBytes(mesh.surface.colors[i])) {
                // Four digits tell the 256 steps apart.
                output.put(' ');
                output.putText(std::round(byte * 1e4 / 255) / 1e4);
            }
        }
        output.put('\n');
    }
    for (const Vec3f& normal : mesh.surface.normals) {
        output.put("vn");
        Vec3d rounded;
        // Nothing is added to what is not 0, and -0 becomes 0.
        for (int k = 0; k < 3; ++k) rounded[k] = std::round(normal[k] * 1e5) / 1e5 + 0.0;
        putNumbers<double>(output, rounded);
        output.put('\n');
    }
    for (const openvdb::Vec3I& triangle : mesh.surface.mesh.triangles) {
        output.put('f');
        for (int k = 0; k < 3; ++k) {
            output.put(' ');
            output.putText(triangle[k] + 1);
            output.put("//");
            output.putText(triangle[k] + 1);
        }
        output.put('\n');
    }
}

void writeStl(ByteOutput& output, const WritableMesh& mesh) {
    constexpr std::size_t kHead = 80;
    std::string head = signature();
    head.resize(kHead, ' ');
    output.put(head);
    output.put(static_cast<std::uint32_t>(mesh.surface.mesh.triangles.size()));
    for (const openvdb::Vec3I& triangle : mesh.surface.mesh.triangles) {
        std::array<Vec3f, 4> rows;
        for (int k = 0; k < 3; ++k) rows[k + 1] = Vec3f(mesh.surface.mesh.points[triangle[k]]);
        rows[0] = facetNormal(rows[1], rows[2], rows[3]);
        for (const Vec3f& row : rows) {
            for (int k = 0; k < 3; ++k) output.put(row[k]);
        }
        output.put(std::string_view("\0\0", 2));
    }
}

}  // namespace bandvox

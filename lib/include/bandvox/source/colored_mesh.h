#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>
#include <bandvox/source/texture.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bandvox {

/// The colour of a triangle: what its corners have, interpolated linearly, times its texture.
struct TrianglePaint {
    static constexpr int kNoTexture = -1;
    static constexpr int kNoColor = -2;

    std::array<openvdb::Vec3f, 3> color;  ///< linear light, [0, 1]
    std::array<openvdb::Vec2f, 3> uv;     ///< texture coordinates; (0, 0) is the lower left
    int texture = kNoColor;               ///< of ColoredMesh::textures, or one of those above
};

/// A picture as a material uses it.
struct MeshTexture {
    std::shared_ptr<const Texture> picture;
    TextureWraps wraps;
};

/// Triangles and their colours. Nothing is promised about orientation or closedness.
struct ColoredMesh {
    std::string name;                   ///< what it was made from, as a file's name
    Mesh mesh;                          ///< as its file has it, before any repair
    std::vector<TrianglePaint> paints;  ///< one for each triangle
    std::vector<MeshTexture> textures;
};

/// A mesh and its colours as their files have them.
struct ColoredMeshFile {
    ColoredMesh colored;
    std::size_t objects = 0;            ///< meshes in the file, instances counted each
    std::size_t triangles = 0;          ///< that have a colour
    std::vector<std::string> warnings;  ///< what looks wrong but could be read
};

/// Reads a polygon mesh (see readMesh) and the colours of its surface: those of its points, else
/// those of its materials and of the textures that they name, files or parts of the mesh file.
///
/// All become linear light. glTF says that colours of points and materials are that already, and
/// multiplies them with one another and with the texture; those of other kinds of file are taken
/// for sRGB, as what writes them shows them, and so are the texels of all pictures but those of
/// floating-point numbers. Alpha is left out. A texture that cannot be used is a warning that
/// names it, and the material's colour stands for it.
/// Throws as readMesh does; Error(ErrorKind::Input) if no triangle has a colour, or if a colour or
/// a texture coordinate is not finite; Error(ErrorKind::Memory) if a texture would not fit.
ColoredMeshFile readColoredMesh(const std::filesystem::path& path,
                                Progress& progress = silentProgress());

}  // namespace bandvox

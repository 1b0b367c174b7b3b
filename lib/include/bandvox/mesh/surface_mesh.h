#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/Types.h>

#include <string>
#include <vector>

namespace bandvox {

/// A closed surface as triangles, with what its points know of it.
struct SurfaceMesh {
    Mesh mesh;                            ///< world units; counter-clockwise from outside
    std::vector<openvdb::Vec3f> normals;  ///< one for each point, outward, of length 1
    std::vector<openvdb::Vec3f>
        colors;  ///< one for each point, linear light; empty without colours
    /// Lines of text about the mesh, without control characters, that go into files which have
    /// room for them: .obj .ply .gltf .glb.
    std::vector<std::string> notes = {};
};

}  // namespace bandvox

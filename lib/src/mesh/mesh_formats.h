#pragma once

#include "mesh/byte_output.h"

#include <bandvox/mesh/surface_mesh.h>

#include <openvdb/math/BBox.h>

#include <string>
#include <vector>

namespace bandvox {

/// A mesh that is fit to be written.
struct WritableMesh {
    const SurfaceMesh& surface;
    openvdb::BBoxd box;        ///< of the points, world units
    bool needsDouble = false;  ///< single precision would be coarse for where the mesh is
    std::vector<std::string> notes = {};

    bool hasColors() const { return !surface.colors.empty(); }
};

// Each writes all of a file, without closing it; throws as ByteOutput::put.

void writePly(ByteOutput& output, const WritableMesh& mesh);
void writeObj(ByteOutput& output, const WritableMesh& mesh);
void writeStl(ByteOutput& output, const WritableMesh& mesh);

/// Throws Error(ErrorKind::Result) if the file would be longer than 4 GiB, which is all that its
/// head can say.
void writeGlb(ByteOutput& output, const WritableMesh& mesh);

/// The same with the numbers in the text, in base 64.
void writeGltf(ByteOutput& output, const WritableMesh& mesh);

}  // namespace bandvox

#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/openvdb.h>

#include <functional>

// Surfaces of known form.
namespace bandvox::compare_test {

/// A sphere of triangles with their corners on it: a cube's faces of so many squares a side, blown
/// up.
Mesh sphere(const openvdb::Vec3d& center, double radius, int squares);

/// A cube [-1, 1]³ with edges and corners of a radius, 0 to 1; faces of so many squares a side.
Mesh roundedCube(double radius, int squares);

/// A torus around z through circles of so many points.
Mesh torus(double major, double minor, int points);

/// Both in one.
Mesh joined(const Mesh& a, const Mesh& b);

/// A level set on a lattice of voxels of a side: a signed distance, negative inside, known in
/// [-half, half]³ of the world around the origin.
openvdb::FloatGrid::Ptr levelSet(const std::function<double(const openvdb::Vec3d&)>& distance,
                                 double half, double voxel);

}  // namespace bandvox::compare_test

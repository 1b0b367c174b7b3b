#pragma once

#include <bandvox/core/error.h>
#include <bandvox/source/mesh.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bandvox::mesh_test {

/// What is wrong with a mesh that should be closed and manifold: each directed edge once and its
/// opposite once, around each point one fan of triangles, no point without triangles, no triangle
/// with a corner twice, all indices in range. Empty if nothing is.
std::string flaw(const Mesh& mesh);

/// What is enclosed, world units³; negative if the mesh is inside out.
double enclosedVolume(const Mesh& mesh);

/// V - E + F, of a closed mesh.
long eulerNumber(const Mesh& mesh);

/// Connected pieces.
std::size_t pieces(const Mesh& mesh);

/// Distances to a mesh, found by looking at all of its triangles.
class MeshDistance {
  public:
    explicit MeshDistance(const Mesh& mesh);

    /// From a place to the nearest triangle, world units.
    double operator()(const openvdb::Vec3d& place) const;

  private:
    struct Ball {
        openvdb::Vec3d center;
        double radius;
    };
    const Mesh& mMesh;
    std::vector<Ball> mBalls;       // around the triangles
    mutable std::size_t mLast = 0;  // triangle that was the nearest
};

/// How many pairs of triangles pass through each other.
std::size_t meetings(const Mesh& mesh);

/// The kind of error that something throws, or ErrorKind::Interrupted for none.
ErrorKind kindOf(const std::function<void()>& run);

/// A grid of the values of a function at index coordinates from -side to side, active all over,
/// background 0, voxels of size 1.
openvdb::FloatGrid::Ptr sampled(int side, const std::function<double(const openvdb::Vec3d&)>& f);

/// Waves of random direction, length and phase, no shorter than 1/`highest` voxels, which fade from
/// the origin like exp(-(r/reach)²): as good as band-limited, and full of ambiguous cells.
class RandomWaves {
  public:
    RandomWaves(unsigned seed, double highest, double reach);
    double operator()(const openvdb::Vec3d& index) const;

  private:
    struct Wave {
        openvdb::Vec3d frequency;
        double phase;
    };
    std::vector<Wave> mWaves;
    double mReach;
};

}  // namespace bandvox::mesh_test

#pragma once

#include <bandvox/source/colored_mesh.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <array>
#include <functional>
#include <vector>

namespace bandvox {

/// (h * (c δ_S)) / (h * δ_S) for a Gaussian, whose h is known: a sum over many points of the
/// surface, in double precision. The slow truth.
class DirectColor {
  public:
    /// The colour of a triangle at barycentric coordinates.
    using Paint = std::function<openvdb::Vec3d(std::size_t triangle, const openvdb::Vec3d&)>;

    /// `cutoff` of the Gaussian in cycles per voxel; points are `spacing` voxels apart, or less.
    DirectColor(const Mesh& mesh, double voxelSize, double cutoff, double spacing,
                const Paint& paint);

    openvdb::Vec3d operator()(const openvdb::Coord& voxel) const { return sums(voxel).color; }

    /// h * δ_S as a part of what it is on a flat face.
    double areaShare(const openvdb::Coord& voxel) const { return sums(voxel).share; }

    /// The largest difference of any channel at every `stride`-th active voxel of a grid, of those
    /// where h * δ_S is at least `leastShare` of what it is on a flat face.
    double largestError(const openvdb::Vec3SGrid& grid, int stride, double leastShare = 0) const;

  private:
    struct Point {
        openvdb::Vec3d position, color;
        double area;
    };
    struct Sums {
        openvdb::Vec3d color;
        double share;
    };

    void add(std::size_t triangle, const std::array<openvdb::Vec3d, 3>& corner,
             const std::array<openvdb::Vec3d, 3>& weights, const Paint& paint);
    Sums sums(const openvdb::Coord& voxel) const;

    double mCutoff, mSpacing;
    std::vector<Point> mPoints;
};

/// The paint that a mesh has, without textures.
DirectColor::Paint cornerPaint(const ColoredMesh& mesh);

}  // namespace bandvox

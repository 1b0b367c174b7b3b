#include "source/compensated_sum.h"
#include "source/index_blocks.h"
#include "source/region_clip.h"
#include "source/triangle_sampling.h"

#include <bandvox/core/error.h>
#include <bandvox/source/mesh_source.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace bandvox {

using openvdb::BBoxd;
using openvdb::Vec3d;

MeshSource::MeshSource(std::string name, Mesh mesh)
    : mName(std::move(name)), mMesh(std::move(mesh)) {
    struct Block {
        BBoxd bounds;
        CompensatedSum volume, area;
    };
    const std::size_t count = mMesh.triangles.size();
    std::vector<Block> blocks(indexBlocks(count));
    forEachIndexBlock(count, [&](std::size_t begin, std::size_t end) {
        BBoxd& bounds = blocks[begin / kIndexBlock].bounds;
        for (std::size_t i = begin; i < end; ++i) bounds.expand(elementBounds(i));
    });
    for (const Block& block : blocks) mBounds.expand(block.bounds);

    // Sum relative to the middle of the box: far from the origin the volumes would cancel.
    const Vec3d middle = mMesh.triangles.empty() ? Vec3d(0) : mBounds.getCenter();
    forEachIndexBlock(count, [&](std::size_t begin, std::size_t end) {
        Block& block = blocks[begin / kIndexBlock];
        for (std::size_t i = begin; i < end; ++i) {
            const openvdb::Vec3I& t = mMesh.triangles[i];
            const Vec3d a = mMesh.points[t[0]] - middle;
            const Vec3d b = mMesh.points[t[1]] - middle;
            const Vec3d c = mMesh.points[t[2]] - middle;
            const Vec3d normal = (b - a).cross(c - a);
            block.volume.add(a.dot(normal) / 6.0);
            block.area.add(0.5 * normal.length());
        }
    });
    CompensatedSum volume, area;
    for (const Block& block : blocks) {
        volume.add(block.volume);
        area.add(block.area);
    }
    mVolume = volume.value();
    mArea = area.value();
    if (!std::isfinite(mArea) || !std::isfinite(mVolume)) {
        throw Error(ErrorKind::Input, "\"" + mName +
                                          "\" has a coordinate that is not finite, or so "
                                          "large that its volume is not; expected finite ones");
    }
}

BBoxd MeshSource::elementBounds(std::size_t i) const {
    const openvdb::Vec3I& t = mMesh.triangles[i];
    BBoxd box(mMesh.points[t[0]], mMesh.points[t[0]]);
    box.expand(mMesh.points[t[1]]);
    box.expand(mMesh.points[t[2]]);
    return box;
}

void MeshSource::sampleElement(std::size_t i, const SamplingRegion& region,
                               const SurfaceQuadrature& quadrature,
                               std::vector<SurfaceSample>& samples) const {
    requireUsefulLength(quadrature.triangleEdge.back(), "triangle edge");
    const openvdb::Vec3I& t = mMesh.triangles[i];
    std::array<Vec3d, 3> corner = {mMesh.points[t[0]] / region.voxelSize,
                                   mMesh.points[t[1]] / region.voxelSize,
                                   mMesh.points[t[2]] / region.voxelSize};
    // Work relative to a whole voxel at the triangle, so that rounding does not depend on where
    // in the world it lies: shifted by whole voxels, it gives the same samples to the last bit.
    const Vec3d base(std::floor(corner[0][0]), std::floor(corner[0][1]), std::floor(corner[0][2]));
    for (Vec3d& c : corner) c -= base;
    const SamplingRegion local{region.voxelSize, region.origin - base, region.extent};
    const Vec3d areaVector = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (areaVector.lengthSqr() == 0.0) return;
    const RegionClip clip(local);
    sampleTriangle(corner, quadrature, clip, [&](const TriangleCell<Vec3d>& cell) {
        const Vec3d cellArea = cell.share * areaVector;
        const Vec3d e1 = cell.corner[1] - cell.corner[0];
        const Vec3d e2 = cell.corner[2] - cell.corner[0];
        for (const TrianglePoint& p : cell.rule) {
            clip.append(cell.corner[0] + p.b * e1 + p.c * e2, p.weight * cellArea, samples);
        }
    });
}

}  // namespace bandvox

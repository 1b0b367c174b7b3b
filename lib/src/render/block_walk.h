#pragma once

#include <bandvox/render/camera.h>

#include <openvdb/math/BBox.h>
#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <limits>
#include <optional>

// Trees that have one voxel for each block of 2^n × 2^n × 2^n voxels of a lattice.
namespace bandvox {

using BlockRay = openvdb::math::Ray<double>;

/// A ray of a lattice, from t = 0 to `end`, in blocks of `side` voxels.
inline BlockRay inBlocks(const Ray& ray, int side,
                         double end = std::numeric_limits<double>::max()) {
    return BlockRay(ray.origin / side, ray.direction / side, 0.0, end);
}

/// The box of the active blocks of a tree, ends included, in blocks. Trees count whole nodes in; so
/// does the box.
template <typename BlockTree>
openvdb::BBoxd boxOfBlocks(const BlockTree& blocks) {
    openvdb::CoordBBox box;
    blocks.evalActiveVoxelBoundingBox(box);
    return {box.min().asVec3d(), box.max().offsetBy(1).asVec3d()};
}

/// Calls `visit(t0, t1, value)` for each active block on the way of a ray, in order; stops when it
/// returns true. `box` is that of the blocks.
template <typename BlockTree, typename Visitor>
void walkBlocks(const BlockTree& blocks, const openvdb::BBoxd& box, BlockRay blockRay,
                const Visitor& visit) {
    if (box.empty() || !blockRay.clip(box)) return;

    // Step over the tree's leaves, and inside each over its blocks.
    using Leaf = typename BlockTree::LeafNodeType;
    const openvdb::tree::ValueAccessor<const BlockTree, false> accessor(blocks);
    typename BlockTree::ValueType value;
    openvdb::math::DDA<BlockRay, Leaf::LOG2DIM> outer(blockRay);
    do {
        const Leaf* leaf = accessor.probeConstLeaf(outer.voxel());
        if (!leaf) {
            if (accessor.probeValue(outer.voxel(), value) &&
                visit(outer.time(), outer.next(), value)) {
                return;
            }
            continue;
        }
        openvdb::math::DDA<BlockRay, 0> inner(blockRay, outer.time(), outer.next());
        do {
            if (leaf->probeValue(inner.voxel(), value) &&
                visit(inner.time(), inner.next(), value)) {
                return;
            }
        } while (inner.step());
    } while (outer.step());
}

}  // namespace bandvox

#include "voxelize/voxel_lattice.h"

#include "core/smallest_voxel.h"
#include "voxelize/bit_column.h"
#include "voxelize/voxel_column.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace bandvox {

namespace {

// OpenVDB's indices go to 2^31; room is left for what is added to them.
constexpr int kLargestIndexLog2 = 30;
constexpr int kMostVoxels = 1 << 20;  // along a side

template <typename... Parts>
[[noreturn]] void fail(ErrorKind kind, const Parts&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    throw Error(kind, message.str());
}

void requireValid(const VoxelOptions& options) {
    if (options.voxelSize == 0 && (options.resolution < 1 || options.resolution > kMostVoxels)) {
        fail(ErrorKind::Usage, "the resolution is ", options.resolution,
             "; it must be between 1 and ", kMostVoxels);
    }
    if (!(options.voxelSize >= 0 && std::isfinite(options.voxelSize))) {
        fail(ErrorKind::Usage, "the voxel size is ", options.voxelSize,
             "; it must be positive, in world units");
    }
    if (options.threshold < 0 || options.threshold > kSubSamples) {
        fail(ErrorKind::Usage, "the threshold is ", options.threshold,
             "; it must be between 1 and 8 sub-samples, or 0 for the voxel's centre");
    }
    if (options.fraction && options.threshold != 0) {
        fail(ErrorKind::Usage, "both a threshold and the fraction of sub-samples are asked for; ",
             "expected one of them");
    }
}

}  // namespace

openvdb::Coord VoxelLattice::corner() const {
    return firstBlock << kBlockLog2;
}

openvdb::Coord VoxelLattice::inGrid(const openvdb::Coord& place) const {
    const std::array<int, 3> order = scanOrder(axis);
    openvdb::Coord result;
    for (int i = 0; i < 3; ++i) result[order[i]] = place[i];
    return result;
}

openvdb::Vec3d VoxelLattice::sample(const openvdb::Coord& voxel) const {
    return voxelSize * (inGrid(voxel).asVec3d() + openvdb::Vec3d(offset));
}

VoxelLattice layOutVoxels(const std::string& name, const openvdb::BBoxd& bounds,
                          const VoxelOptions& options) {
    requireValid(options);
    const openvdb::Vec3d size = bounds.extents();
    const double longest = std::max({size.x(), size.y(), size.z()});
    if (!(longest > 0)) fail(ErrorKind::Input, name, ": its box has no size");

    const double voxelSize =
        options.voxelSize > 0 ? options.voxelSize : longest / options.resolution;
    if (voxelSize < kSmallestVoxel) {
        fail(options.voxelSize > 0 ? ErrorKind::Usage : ErrorKind::Input, name,
             ": a voxel would be ", voxelSize,
             " world units, and OpenVDB's transforms take no less than ", kSmallestVoxel,
             options.voxelSize > 0 ? "; use larger ones" : "; scale the object up");
    }
    const openvdb::Vec3d low = bounds.min() / voxelSize;
    const openvdb::Vec3d high = bounds.max() / voxelSize;
    VoxelLattice lattice;
    lattice.voxelSize = voxelSize;
    lattice.axis = options.axis;
    const std::array<int, 3> order = scanOrder(options.axis);
    // Sub-samples have twice the index.
    const int largestLog2 = kLargestIndexLog2 - (options.subSamples() ? 1 : 0);
    const double largest = std::ldexp(1.0, largestLog2);
    for (int i = 0; i < 3; ++i) {
        const int axis = order[i];
        // Written so that a NaN fails too.
        if (!(low[axis] > -largest && high[axis] < largest)) {
            fail(ErrorKind::Usage, "with voxels of ", voxelSize,
                 " world units the object reaches index ", std::max(-low[axis], high[axis]),
                 ", and indices must stay below 2^", largestLog2);
        }
        if (!(high[axis] - low[axis] < kMostVoxels + 0.5)) {
            fail(ErrorKind::Usage, "with voxels of ", voxelSize, " world units the object is ",
                 high[axis] - low[axis], " voxels long; it must be at most ", kMostVoxels);
        }
        // Whole voxels more than the box: what rounds to its faces is still inside.
        lattice.voxels.min()[i] = static_cast<int>(std::floor(low[axis]));
        lattice.voxels.max()[i] = static_cast<int>(std::ceil(high[axis]));
    }
    lattice.firstBlock = lattice.voxels.min() >> kBlockLog2;
    lattice.blockCount = (lattice.voxels.max() >> kBlockLog2) - lattice.firstBlock;
    lattice.blockCount.offset(1);
    return lattice;
}

VoxelLattice subSampleLattice(const VoxelLattice& lattice) {
    VoxelLattice fine = lattice;
    fine.voxelSize = lattice.voxelSize / 2;
    fine.offset = -0.5;
    fine.voxels.min() = lattice.voxels.min() << 1;
    fine.voxels.max() = (lattice.voxels.max() << 1).offsetBy(1);
    fine.firstBlock = lattice.firstBlock << 1;
    fine.blockCount = lattice.blockCount << 1;
    return fine;
}

void requireVoxelMemory(const VoxelLattice& lattice, double area) {
    constexpr double kBytesPerLeaf = 2048 + 128;
    constexpr double kMostBlocksPerFace = 1.8;  // √3 on a diagonal plane, and a little more
    const openvdb::Coord& count = lattice.blockCount;
    const double blocks = static_cast<double>(count.x()) * count.y() * count.z();
    const double face = std::pow(kBlockSide * lattice.voxelSize, 2);
    const double leaves = std::min(blocks, kMostBlocksPerFace * area / face);
    std::ostringstream what;
    what << "a grid of voxels of " << lattice.voxelSize << " world units";
    requireMemory(
        leaves * kBytesPerLeaf + static_cast<double>(lattice.columnCount()) * sizeof(ColumnVoxels),
        what.str().c_str());
}

}  // namespace bandvox

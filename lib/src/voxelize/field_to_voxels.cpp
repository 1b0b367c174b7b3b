#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/field_to_voxels.h>

#include <algorithm>
#include <vector>

namespace bandvox {

namespace {

constexpr float kInside = 0.5F;

// Appends where a row of values, the first at voxel `begin`, enters and leaves the solid.
void appendCrossings(const std::vector<float>& values, int begin, int row,
                     std::vector<RowCrossing>& crossings) {
    const auto add = [&](std::size_t i, int change) {
        crossings.push_back({begin + static_cast<int>(i), static_cast<std::int16_t>(row),
                             static_cast<std::int16_t>(change)});
    };
    bool inside = false;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (inside == (values[i] >= kInside)) continue;
        inside = !inside;
        add(i, inside ? 1 : -1);
    }
    if (inside) add(values.size(), -1);
}

ColumnVoxels sampleColumn(const FieldSource& source, const VoxelLattice& lattice,
                          const openvdb::Coord& block) {
    const openvdb::CoordBBox& box = lattice.voxels;
    const openvdb::Coord corner = block << kBlockLog2;
    std::vector<float> values(box.dim().x());
    std::vector<RowCrossing> crossings;
    for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
        const openvdb::Coord start(box.min().x(), corner.y() + row / kBlockSide,
                                   corner.z() + row % kBlockSide);
        if (!box.isInside(start)) continue;
        source.sampleRow(lattice.voxelSize * start.asVec3d(),
                         openvdb::Vec3d(lattice.voxelSize, 0, 0), values);
        appendCrossings(values, start.x(), row, crossings);
    }
    return fillColumn(block, crossings);
}

}  // namespace

VoxelResult fieldToVoxels(const FieldSource& source, const VoxelOptions& options,
                          Progress& progress) {
    const openvdb::BBoxd bounds = source.bounds();
    const VoxelLattice lattice = layOutVoxels(source.name(), bounds, options);
    // Of a field nothing is known but its box.
    const openvdb::Vec3d size = bounds.extents();
    requireVoxelMemory(lattice,
                       2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()));

    std::vector<ColumnVoxels> columns(lattice.columnCount());
    {
        const ProgressStage stage(progress, "voxelizing", lattice.columnCount());
        parallelFor(lattice.columnCount(), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            columns[i] = sampleColumn(source, lattice, lattice.columnBlock(i));
            progress.advance();
        });
    }
    const ProgressStage stage(progress, "assembling", 0);
    return assembleVoxels(source.name(), lattice, columns);
}

}  // namespace bandvox

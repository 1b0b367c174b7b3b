#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/field_to_voxels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox {

namespace {

constexpr float kInside = 0.5F;
constexpr double kOnFace = 1e-6;  // samples this near to a face of the box lie on it, voxels

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

// The voxels whose samples lie in the source's box. Outside of it the field may have any value.
openvdb::CoordBBox sampledVoxels(const FieldSource& source, const VoxelLattice& lattice) {
    const std::array<int, 3> order = scanOrder(lattice.axis);
    const openvdb::BBoxd bounds = source.bounds();
    openvdb::CoordBBox box;
    for (int i = 0; i < 3; ++i) {
        const double low = bounds.min()[order[i]] / lattice.voxelSize - lattice.offset;
        const double high = bounds.max()[order[i]] / lattice.voxelSize - lattice.offset;
        box.min()[i] = static_cast<int>(std::ceil(low - kOnFace));
        box.max()[i] = static_cast<int>(std::floor(high + kOnFace));
    }
    box.intersect(lattice.voxels);
    return box;
}

// `box`: the voxels to sample.
BitColumn sampleColumn(const FieldSource& source, const VoxelLattice& lattice,
                       const openvdb::CoordBBox& box, const openvdb::Coord& block) {
    if (box.empty()) return {};
    const openvdb::Coord corner = block << kBlockLog2;
    const openvdb::Vec3d step =
        lattice.voxelSize * lattice.inGrid(openvdb::Coord(1, 0, 0)).asVec3d();
    std::vector<float> values(box.dim().x());
    std::vector<RowCrossing> crossings;
    for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
        const openvdb::Coord start(box.min().x(), corner.y() + row / kBlockSide,
                                   corner.z() + row % kBlockSide);
        if (!box.isInside(start)) continue;
        source.sampleRow(lattice.sample(start), step, values);
        appendCrossings(values, start.x(), row, crossings);
    }
    return fillColumn(crossings);
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

    const VoxelLattice samples = sampleLattice(lattice, options);
    const openvdb::CoordBBox box = sampledVoxels(source, samples);
    const auto sample = [&](const openvdb::Coord& block) {
        return sampleColumn(source, samples, box, block);
    };
    std::vector<ColumnVoxels> columns(lattice.columnCount());
    {
        const ProgressStage stage(progress, "voxelizing", lattice.columnCount());
        parallelFor(lattice.columnCount(), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            columns[i] = makeColumn(lattice, options, lattice.columnBlock(i), sample);
            progress.advance();
        });
    }
    const ProgressStage stage(progress, "assembling", 0);
    return assembleVoxels(source.name(), lattice, options, columns);
}

}  // namespace bandvox

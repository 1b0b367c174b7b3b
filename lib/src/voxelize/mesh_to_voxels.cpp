#include "voxelize/lattice_mesh.h"
#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/mesh_to_voxels.h>

#include <algorithm>
#include <vector>

namespace bandvox {

namespace {

std::vector<ColumnVoxels> scanColumns(const MeshSource& source, const VoxelLattice& lattice,
                                      Progress& progress) {
    const LatticeMesh mesh(source.mesh(), lattice);
    std::vector<ColumnVoxels> columns(lattice.columnCount());
    const ProgressStage stage(progress, "voxelizing", lattice.columnCount());
    parallelFor(lattice.columnCount(), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const openvdb::Coord block = lattice.columnBlock(i);
        std::vector<RowCrossing> crossings;
        mesh.cross(block, crossings);
        columns[i] = fillColumn(block, crossings);
        progress.advance();
    });
    return columns;
}

}  // namespace

VoxelResult meshToVoxels(const MeshSource& source, const VoxelOptions& options,
                         Progress& progress) {
    const VoxelLattice lattice = layOutVoxels(source.name(), source.bounds(), options);
    requireVoxelMemory(lattice, source.area());

    std::vector<ColumnVoxels> columns = scanColumns(source, lattice, progress);
    if (!std::all_of(columns.begin(), columns.end(), [](const auto& c) { return c.isClosed; })) {
        throw Error(ErrorKind::Input, source.name() +
                                          ": the mesh is not closed: a line enters it "
                                          "more or less often than it leaves it");
    }
    const bool isInsideOut = std::any_of(columns.begin(), columns.end(),
                                         [](const auto& column) { return column.isInsideOut; });

    const ProgressStage stage(progress, "assembling", 0);
    VoxelResult result = assembleVoxels(source.name(), lattice, columns);
    if (isInsideOut) {
        result.warnings.emplace_back(
            "parts of the surface are inside out; what they enclose counts as outside");
    }
    return result;
}

}  // namespace bandvox

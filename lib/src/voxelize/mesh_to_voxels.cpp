#include "voxelize/lattice_mesh.h"
#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/mesh_to_voxels.h>

#include <vector>

namespace bandvox {

namespace {

std::vector<ColumnVoxels> scanColumns(const MeshSource& source, const VoxelLattice& lattice,
                                      const VoxelOptions& options, Progress& progress) {
    const VoxelLattice samples = sampleLattice(lattice, options);
    const LatticeMesh mesh(source.mesh(), samples);
    const auto scan = [&](const openvdb::Coord& block) {
        std::vector<RowCrossing> crossings;
        mesh.cross(block, crossings);
        return fillColumn(crossings);
    };
    std::vector<ColumnVoxels> columns(lattice.columnCount());
    const ProgressStage stage(progress, "voxelizing", lattice.columnCount());
    parallelFor(lattice.columnCount(), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        columns[i] = makeColumn(lattice, options, lattice.columnBlock(i), scan);
        progress.advance();
    });
    return columns;
}

}  // namespace

VoxelResult meshToVoxels(const MeshSource& source, const VoxelOptions& options,
                         Progress& progress) {
    const VoxelLattice lattice = layOutVoxels(source.name(), source.bounds(), options);
    requireVoxelMemory(lattice, source.area());
    std::vector<ColumnVoxels> columns = scanColumns(source, lattice, options, progress);
    const ProgressStage stage(progress, "assembling", 0);
    return assembleMeshVoxels(source.name(), lattice, options, columns);
}

}  // namespace bandvox

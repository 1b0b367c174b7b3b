#include "voxelize/gl_context.h"
#include "voxelize/gpu_tiles.h"
#include "voxelize/gpu_work.h"
#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <utility>
#include <vector>

namespace bandvox {

VoxelResult meshToVoxelsOnGpu(const MeshSource& source, const VoxelOptions& options,
                              GpuMethod method, Progress& progress) {
    return meshToVoxelsOnGpu(source, options, {.method = method}, progress);
}

VoxelResult meshToVoxelsOnGpu(const MeshSource& source, const VoxelOptions& options,
                              const GpuWork& work, Progress& progress) {
    const VoxelLattice lattice = layOutVoxels(source.name(), source.bounds(), options);
    const VoxelLattice samples = sampleLattice(lattice, options);
    requireGpuLattice(samples);
    requireVoxelMemory(lattice, source.area());

    std::vector<ColumnVoxels> columns(lattice.columnCount());
    const auto take = [&](const ScannedTile& tile) {
        // The columns of voxels whose samples the tile holds.
        const int scale = options.subSamples() ? 1 : 0;
        const openvdb::Coord begin = tile.begin >> scale, end = tile.end >> scale;
        const std::int64_t width = end.z() - begin.z();
        parallelFor((end.y() - begin.y()) * width, [&](std::int64_t i) {
            const openvdb::Coord block(0, begin.y() + static_cast<int>(i / width),
                                       begin.z() + static_cast<int>(i % width));
            const openvdb::Coord place = block - lattice.firstBlock;
            columns[std::int64_t(place.y()) * lattice.blockCount.z() + place.z()] =
                makeColumn(lattice, options, block,
                           [&](const openvdb::Coord& part) { return tile.column(part); });
        });
    };
    const std::string device =
        scanOnGpu(source.mesh(), samples, work.method, work.limits, progress, take);

    const ProgressStage stage(progress, "assembling", 0);
    VoxelResult result = assembleMeshVoxels(source.name(), lattice, options, columns);
    result.device = device;
    return result;
}

OpenGlDevice findGpu() {
    const EglDevices devices = lookAtEglDevices();
    if (devices == EglDevices::NoEgl) return {false, "there is no EGL"};
    if (devices == EglDevices::SoftwareOnly) {
        return {false, "the only OpenGL is a program, like llvmpipe"};
    }
    try {
        const GlContext context;
        if (context.isHardware()) return {true, context.device()};
        return {false, "the only OpenGL is " + context.device() + ", a program"};
    } catch (const Error& error) {
        return {false, error.what()};
    }
}

}  // namespace bandvox

#include "source/mesh_bounds.h"
#include "source/winding_rows.h"
#include "voxelize/lattice_mesh.h"
#include "voxelize/voxel_assembly.h"
#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/soup_to_voxels.h>

#include <cmath>
#include <memory>
#include <vector>

namespace bandvox {

namespace {

// The rows of samples of a soup, and a solid beside it.
class SoupScan {
  public:
    SoupScan(const SoupOfTriangles& triangles, const VoxelLattice& samples, Progress& progress)
        : mSamples(samples),
          mShift(static_cast<int>(std::floor(samples.offset))),
          mRows(WindingTree(triangles.soup), boundsOf(triangles.soup),
                RowLattice::oneToAVoxel(samples.voxelSize, samples.offset - mShift), progress) {
        if (!triangles.solid.triangles.empty()) {
            mSolid = std::make_unique<LatticeMesh>(triangles.solid, samples);
        }
    }

    // What either winds around is inside.
    BitColumn column(const openvdb::Coord& block) const {
        std::vector<RowCrossing> crossings;
        if (mSolid) mSolid->cross(block, crossings);
        const openvdb::Coord corner = block << kBlockLog2;
        for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
            int change = 1;
            for (const float x : mRows.rowOfVoxel(corner.y() + row / kBlockSide + mShift,
                                                  corner.z() + row % kBlockSide + mShift)) {
                const double behind = std::ceil(mRows.xOrigin() + x - mSamples.offset);
                crossings.push_back({static_cast<std::int32_t>(behind),
                                     static_cast<std::int16_t>(row),
                                     static_cast<std::int16_t>(change)});
                change = -change;
            }
        }
        return fillColumn(crossings);
    }

  private:
    const VoxelLattice& mSamples;
    int mShift;  // whole voxels of the samples' offset
    WindingRows mRows;
    std::unique_ptr<LatticeMesh> mSolid;
};

}  // namespace

VoxelResult soupToVoxels(const SoupOfTriangles& triangles, const VoxelOptions& options,
                         Progress& progress) {
    VoxelOptions alongX = options;
    alongX.axis = ScanAxis::X;
    openvdb::BBoxd bounds = boundsOf(triangles.soup);
    if (!triangles.solid.triangles.empty()) bounds.expand(boundsOf(triangles.solid));
    const VoxelLattice lattice = layOutVoxels(triangles.name, bounds, alongX);
    // Of what a soup encloses nothing is known but its box.
    const openvdb::Vec3d size = bounds.extents();
    requireVoxelMemory(lattice,
                       2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x()));
    const VoxelLattice samples = sampleLattice(lattice, alongX);
    const SoupScan scan(triangles, samples, progress);
    std::vector<ColumnVoxels> columns(lattice.columnCount());
    {
        const ProgressStage stage(progress, "voxelizing", lattice.columnCount());
        parallelFor(lattice.columnCount(), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            columns[i] =
                makeColumn(lattice, alongX, lattice.columnBlock(i),
                           [&scan](const openvdb::Coord& block) { return scan.column(block); });
            progress.advance();
        });
    }
    const ProgressStage stage(progress, "assembling", 0);
    return assembleVoxels(triangles.name, lattice, alongX, columns);
}

}  // namespace bandvox

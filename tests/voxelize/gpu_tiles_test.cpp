#include "voxelize/gpu_tiles.h"

#include "voxelize/mesh_patches.h"
#include "voxelize/voxel_meshes.h"

#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

VoxelLattice latticeOf(const openvdb::BBoxd& box) {
    return layOutVoxels("a", box, {.voxelSize = 1});
}

TEST(GpuTiles, HoldEachColumnOnceAndStayWithinLimits) {
    std::mt19937 random(3);
    const auto upTo = [&](int n) { return 1 + static_cast<int>(random() % n); };
    for (int round = 0; round < 300; ++round) {
        const Vec3d size(upTo(900), upTo(900), upTo(300));
        const VoxelLattice lattice = latticeOf({Vec3d(-5.5), Vec3d(-5.5) + size});
        const GpuLimits limits{
            .side = 16 * upTo(40), .bufferBytes = std::int64_t(1) << (9 + upTo(14)), .patches = 10};
        for (const GpuMethod method : {GpuMethod::Bits, GpuMethod::Slices}) {
            const GpuTiling tiling(lattice, method, limits);
            std::map<std::pair<int, int>, int> visits;
            for (const GpuTile& tile : tiling.tiles()) {
                EXPECT_LE(tile.height(), limits.side);
                EXPECT_LE(tile.width(), limits.side);
                EXPECT_EQ(tile.begin().y() % 2, 0);
                EXPECT_EQ(tile.begin().z() % 2, 0);
                // What is behind the last sample is counted, too.
                EXPECT_GE(lattice.corner().x() + 8 * tile.depth(), lattice.voxels.max().x() + 2);
                if (method == GpuMethod::Bits) {
                    EXPECT_LE(tile.columnCount() * tiling.passDepth() * 64, limits.bufferBytes);
                }
                for (int y = tile.begin().y(); y < tile.end().y(); ++y) {
                    for (int z = tile.begin().z(); z < tile.end().z(); ++z) ++visits[{y, z}];
                }
            }
            EXPECT_EQ(static_cast<std::int64_t>(visits.size()), lattice.columnCount());
            for (const auto& [column, times] : visits) EXPECT_EQ(times, 1);
        }
    }
}

TEST(GpuTiles, AreFewWhereThereIsRoom) {
    const VoxelLattice lattice = latticeOf({Vec3d(0.0), Vec3d(511.5)});
    const GpuTiling tiling(lattice, GpuMethod::Bits, {});
    EXPECT_EQ(tiling.tiles().size(), 1u);
    EXPECT_EQ(tiling.steps(), 1);
    EXPECT_EQ(GpuTiling(lattice, GpuMethod::Slices, {}).steps(), 521);
    // Whole rows as long as a tile can be one.
    EXPECT_EQ(GpuTiling(lattice, GpuMethod::Bits, {.bufferBytes = 1 << 16}).passDepth(), 65);
    EXPECT_EQ(GpuTiling(lattice, GpuMethod::Bits, {.bufferBytes = 1 << 10}).passDepth(), 4);
}

TEST(MeshPatches, HoldEachPlaceOfATriangleOnce) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(0, 200);
    for (int round = 0; round < 50; ++round) {
        Mesh mesh;
        for (int k = 0; k < 3; ++k) {
            mesh.points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
        }
        if (round % 2 == 1) mesh.points[2] = 0.5 * (mesh.points[0] + mesh.points[1]) + Vec3d(0.3);
        mesh.triangles.emplace_back(0, 1, 2);
        const VoxelLattice lattice = latticeOf({Vec3d(0.0), Vec3d(200)});
        const std::vector<LatticePoint> points = roundToLattice(mesh, lattice);
        const CoordBBox tile(Coord(0, 16, 32), Coord(207, 143, 175));
        std::map<std::pair<int, int>, int> visits;
        for (const MeshPatch& patch : patchesOf(mesh, points, ScanAxis::X, tile)) {
            for (unsigned y = patch.y & 0xffff; y < patch.y >> 16; ++y) {
                for (unsigned z = patch.z & 0xffff; z < patch.z >> 16; ++z) ++visits[{y, z}];
            }
        }
        for (const auto& [row, times] : visits) EXPECT_EQ(times, 1);
        for (int y = tile.min().y(); y <= tile.max().y(); ++y) {
            for (int z = tile.min().z(); z <= tile.max().z(); ++z) {
                int left = 0;
                for (int k = 0; k < 3; ++k) {
                    const Vec3d &p = mesh.points[k], &q = mesh.points[(k + 1) % 3];
                    left += (q.y() - p.y()) * (z - p.z()) > (q.z() - p.z()) * (y - p.y()) ? 1 : 0;
                }
                if (left == 0 || left == 3) {
                    const std::pair<int, int> row(y - tile.min().y(), z - tile.min().z());
                    ASSERT_EQ(visits.count(row), 1u) << y << " " << z;
                }
            }
        }
    }
}

}  // namespace
}  // namespace bandvox

#include "voxelize/lattice_points.h"

#include <bandvox/core/memory.h>

#include <cmath>

namespace bandvox {

std::vector<LatticePoint> roundToLattice(const Mesh& mesh, const VoxelLattice& lattice) {
    requireMemory(static_cast<double>(sizeof(LatticePoint)) * mesh.points.size(),
                  "the mesh on the lattice");
    const std::array<int, 3> order = scanOrder(lattice.axis);
    const openvdb::Vec3d corner = lattice.corner().asVec3d() + openvdb::Vec3d(lattice.offset);
    std::vector<LatticePoint> points(mesh.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const openvdb::Vec3d voxels = mesh.points[i] / lattice.voxelSize;
        for (int k = 0; k < 3; ++k) {
            points[i][k] = std::llround((voxels[order[k]] - corner[k]) * double(kVoxel));
        }
    }
    return points;
}

}  // namespace bandvox

#include "render/voxel_normals.h"

#include <array>
#include <cstdlib>

namespace bandvox {

namespace {

using openvdb::Coord;
using openvdb::Vec3d;

// The sum of the normals of the faces that meet at a corner: of the 2 × 2 × 2 voxels around it,
// `first` the lowest, each two neighbours share one if one of them is solid.
Vec3d cornerNormal(const Coord& first, const SolidVoxels::Probe& probe) {
    std::array<int, 8> solid{};
    for (int i = 0; i < 8; ++i) {
        solid[i] = probe.isValueOn(first.offsetBy(i & 1, i >> 1 & 1, i >> 2)) ? 1 : 0;
    }
    Vec3d sum(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const int step = 1 << axis;
        for (int i = 0; i < 8; ++i) {
            if ((i & step) == 0) sum[axis] += solid[i] - solid[i + step];
        }
    }
    return sum;
}

Vec3d unitOr(const Vec3d& vector, const Vec3d& fallback) {
    // What cancels out does so exactly, or is as long as rounding.
    constexpr double kNothing = 1e-9;
    return vector.length() > kNothing ? vector.unit() : fallback;
}

}  // namespace

Vec3d faceNormal(const VoxelHit& hit) {
    Vec3d normal(0.0);
    normal[hit.axis] = hit.side;
    return normal;
}

Vec3d phongNormal(const VoxelHit& hit, const Vec3d& place, const SolidVoxels::Probe& probe) {
    const int u = (hit.axis + 1) % 3, v = (hit.axis + 2) % 3;
    const double atU = place[u] - (hit.voxel[u] - 0.5), atV = place[v] - (hit.voxel[v] - 0.5);
    Vec3d sum(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        const int highU = corner & 1, highV = corner >> 1;
        Coord first = hit.voxel;
        if (hit.side < 0) --first[hit.axis];
        first[u] += highU - 1;
        first[v] += highV - 1;
        const double weight = (highU ? atU : 1 - atU) * (highV ? atV : 1 - atV);
        sum += weight * unitOr(cornerNormal(first, probe), faceNormal(hit));
    }
    return unitOr(sum, faceNormal(hit));
}

Vec3d sobelNormal(const VoxelHit& hit, const SolidVoxels::Probe& probe) {
    Vec3d sum(0.0);
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (!probe.isValueOn(hit.voxel.offsetBy(x, y, z))) continue;
                const int wx = 2 - std::abs(x), wy = 2 - std::abs(y), wz = 2 - std::abs(z);
                sum -= Vec3d(x * wy * wz, wx * y * wz, wx * wy * z);
            }
        }
    }
    return unitOr(sum, faceNormal(hit));
}

}  // namespace bandvox

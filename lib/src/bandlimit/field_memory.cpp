#include "bandlimit/field_memory.h"

#include "bandlimit/block_store.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace bandvox {

namespace {

// With more boxes than this, the finer ones are guessed from them.
constexpr std::size_t kMostBoxes = 1 << 18;

struct Box {
    std::int64_t x, y, z;  // first voxel
};

// Whether the field is constant in a cube of voxels and as far around it as the filter reaches.
bool isConstantAround(const FieldSource& source, const Box& box, std::int64_t side, int reach,
                      double voxelSize) {
    const openvdb::Vec3d first(static_cast<double>(box.x), static_cast<double>(box.y),
                               static_cast<double>(box.z));
    const openvdb::Vec3d low = voxelSize * (first - openvdb::Vec3d(reach));
    const openvdb::Vec3d high =
        voxelSize * (first + openvdb::Vec3d(static_cast<double>(side + reach)));
    const openvdb::BBoxd region(low, high);
    return !source.bounds().hasOverlap(region) || source.constantIn(region).has_value();
}

}  // namespace

double estimateVaryingBlocks(const FieldSource& source, const TileGeometry& geometry,
                             const TileLayout& layout) {
    // Begin with one cube around the lattice, and halve those in which the field may vary.
    const openvdb::Coord size = layout.tileOrigin(layout.count) - layout.origin;
    std::int64_t side = DensityLeaf::DIM;
    while (side < std::max({size.x(), size.y(), size.z()})) side *= 2;
    double growth = 8;  // of the number of boxes in one step
    std::vector<Box> boxes{{layout.origin.x(), layout.origin.y(), layout.origin.z()}};
    while (side > DensityLeaf::DIM && boxes.size() < kMostBoxes) {
        side /= 2;
        std::vector<Box> finer;
        for (const Box& box : boxes) {
            for (int corner = 0; corner < 8; ++corner) {
                const Box part{box.x + (corner & 1) * side, box.y + (corner >> 1 & 1) * side,
                               box.z + (corner >> 2) * side};
                if (!isConstantAround(source, part, side, geometry.halo, layout.voxelSize)) {
                    finer.push_back(part);
                }
            }
        }
        growth = static_cast<double>(finer.size()) / static_cast<double>(boxes.size());
        boxes = std::move(finer);
    }
    // Half the side makes four times as many boxes along a surface, eight times where the field
    // varies everywhere: go on as the last step did.
    const double halvings = std::log2(static_cast<double>(side) / DensityLeaf::DIM);
    return static_cast<double>(boxes.size()) * std::pow(growth, halvings);
}

}  // namespace bandvox

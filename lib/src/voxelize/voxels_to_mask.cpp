#include <bandvox/voxelize/voxels.h>

namespace bandvox {

namespace {

constexpr float kInsideMask = 0.5F;

// Carries over what is not the voxels.
void describeLike(openvdb::GridBase& grid, const openvdb::GridBase& other) {
    grid.insertMeta(other);
    grid.setTransform(other.transform().copy());
}

}  // namespace

openvdb::BoolGrid::Ptr voxelsToMask(const openvdb::FloatGrid& voxels) {
    // Start with all that is active; take away what is less than half inside.
    auto mask = openvdb::BoolGrid::create(
        std::make_shared<openvdb::BoolTree>(voxels.tree(), false, true, openvdb::TopologyCopy()));
    for (auto value = voxels.cbeginValueOn(); value; ++value) {
        if (*value >= kInsideMask) continue;
        if (value.isVoxelValue()) {
            mask->tree().setValueOff(value.getCoord(), false);
        } else {
            mask->tree().fill(value.getBoundingBox(), false, false);
        }
    }
    mask->pruneGrid();
    describeLike(*mask, voxels);
    mask->setName("mask");
    mask->setGridClass(openvdb::GRID_UNKNOWN);
    return mask;
}

openvdb::FloatGrid::Ptr maskToVoxels(const openvdb::BoolGrid& mask) {
    auto voxels = openvdb::FloatGrid::create(
        std::make_shared<openvdb::FloatTree>(mask.tree(), 0.0F, 1.0F, openvdb::TopologyCopy()));
    describeLike(*voxels, mask);
    voxels->setName("density");
    voxels->setGridClass(openvdb::GRID_FOG_VOLUME);
    return voxels;
}

}  // namespace bandvox

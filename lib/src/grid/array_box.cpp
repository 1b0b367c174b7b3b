#include <bandvox/grid/array_box.h>

namespace bandvox {

namespace {

constexpr const char* kBoxMin = "bandvox_array_min";
constexpr const char* kBoxMax = "bandvox_array_max";

void dropEntry(openvdb::GridBase& grid, const char* name) {
    if (grid[name]) grid.removeMeta(name);
}

}  // namespace

void setArrayBox(openvdb::GridBase& grid, const openvdb::CoordBBox& box) {
    dropArrayBox(grid);
    grid.insertMeta(kBoxMin, openvdb::Vec3IMetadata(box.min().asVec3i()));
    grid.insertMeta(kBoxMax, openvdb::Vec3IMetadata(box.max().asVec3i()));
}

void dropArrayBox(openvdb::GridBase& grid) {
    dropEntry(grid, kBoxMin);
    dropEntry(grid, kBoxMax);
}

openvdb::CoordBBox arrayBox(const openvdb::GridBase& grid) {
    const openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
    const auto low = grid.getMetadata<openvdb::Vec3IMetadata>(kBoxMin);
    const auto high = grid.getMetadata<openvdb::Vec3IMetadata>(kBoxMax);
    if (!low || !high) return active;
    const openvdb::CoordBBox stored(openvdb::Coord(low->value()), openvdb::Coord(high->value()));
    return !stored.empty() && (active.empty() || stored.isInside(active)) ? stored : active;
}

}  // namespace bandvox

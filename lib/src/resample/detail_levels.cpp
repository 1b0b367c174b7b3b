#include <bandvox/core/error.h>
#include <bandvox/resample/detail_levels.h>

#include <string>

namespace bandvox {

namespace {

constexpr int kMostLevels = 16;

}  // namespace

std::vector<openvdb::FloatGrid::Ptr> makeDetailLevels(const openvdb::FloatGrid::ConstPtr& grid,
                                                      int levels, const ResampleOptions& options,
                                                      Progress& progress) {
    if (levels < 1 || levels > kMostLevels) {
        throw Error(ErrorKind::Usage, "there are " + std::to_string(levels) +
                                          " levels of detail; expected 1 to " +
                                          std::to_string(kMostLevels));
    }
    if (!grid) throw Error(ErrorKind::Usage, "levels of detail need a grid, but got none");
    std::vector<openvdb::FloatGrid::Ptr> result;
    openvdb::FloatGrid::ConstPtr finer = grid;
    for (int level = 1; level <= levels; ++level) {
        const openvdb::math::Transform::Ptr lattice = finer->transform().copy();
        lattice->preScale(2.0);
        const auto coarser = resampleGrid(finer, *lattice, options, progress).grid;
        nameDetailLevel(*coarser, *grid, level);
        result.push_back(coarser);
        finer = coarser;
    }
    return result;
}

void nameDetailLevel(openvdb::GridBase& grid, const openvdb::GridBase& finest, int level) {
    grid.setName(finest.getName() + "_level_" + std::to_string(level));
    if (grid["MultiResGrid_Level"]) grid.removeMeta("MultiResGrid_Level");
    grid.insertMeta("MultiResGrid_Level", openvdb::Int64Metadata(level));
}

}  // namespace bandvox

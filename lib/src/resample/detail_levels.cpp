#include <bandvox/core/error.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/resample/resample_vectors.h>

#include <string>

namespace bandvox {

namespace {

constexpr int kMostLevels = 16;

// Each level is made of the one before.
template <typename Grid, typename Resample>
std::vector<typename Grid::Ptr> levelsOf(const typename Grid::ConstPtr& grid, int levels,
                                         const Resample& resample) {
    if (levels < 1 || levels > kMostLevels) {
        throw Error(ErrorKind::Usage, "there are " + std::to_string(levels) +
                                          " levels of detail; expected 1 to " +
                                          std::to_string(kMostLevels));
    }
    if (!grid) throw Error(ErrorKind::Usage, "levels of detail need a grid, but got none");
    std::vector<typename Grid::Ptr> result;
    typename Grid::ConstPtr finer = grid;
    for (int level = 1; level <= levels; ++level) {
        const openvdb::math::Transform::Ptr lattice = finer->transform().copy();
        lattice->preScale(2.0);
        const typename Grid::Ptr coarser = resample(finer, *lattice);
        nameDetailLevel(*coarser, *grid, level);
        result.push_back(coarser);
        finer = coarser;
    }
    return result;
}

}  // namespace

std::vector<openvdb::FloatGrid::Ptr> makeDetailLevels(const openvdb::FloatGrid::ConstPtr& grid,
                                                      int levels, const ResampleOptions& options,
                                                      Progress& progress) {
    return levelsOf<openvdb::FloatGrid>(
        grid, levels, [&](const auto& finer, const openvdb::math::Transform& lattice) {
            return resampleGrid(finer, lattice, options, progress).grid;
        });
}

std::vector<openvdb::Vec3SGrid::Ptr> makeDetailLevels(const openvdb::Vec3SGrid::ConstPtr& grid,
                                                      int levels, const ResampleOptions& options,
                                                      Progress& progress) {
    return levelsOf<openvdb::Vec3SGrid>(
        grid, levels, [&](const auto& finer, const openvdb::math::Transform& lattice) {
            return resampleVectors(finer, lattice, options, progress);
        });
}

void nameDetailLevel(openvdb::GridBase& grid, const openvdb::GridBase& finest, int level) {
    grid.setName(finest.getName() + "_level_" + std::to_string(level));
    if (grid["MultiResGrid_Level"]) grid.removeMeta("MultiResGrid_Level");
    grid.insertMeta("MultiResGrid_Level", openvdb::Int64Metadata(level));
}

}  // namespace bandvox

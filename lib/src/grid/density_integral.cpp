#include <bandvox/grid/density_grid.h>

#include <cmath>

namespace bandvox {

double densityIntegral(const openvdb::FloatGrid& grid) {
    double sum = 0;
    // Sum each leaf by itself first, so that many small values are not lost beside a large sum.
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        double leafSum = 0;
        for (auto value = leaf->cbeginValueOn(); value; ++value) leafSum += *value;
        sum += leafSum;
    }
    auto tile = grid.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) sum += static_cast<double>(*tile) * tile.getVoxelCount();
    // A voxel's volume is the determinant of the map's linear part, which is negative of a mirror.
    return sum * std::abs(grid.transform().voxelVolume());
}

}  // namespace bandvox

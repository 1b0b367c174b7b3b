#include "source/winding_rows.h"

#include "source/bundle_march.h"
#include "source/row_intervals.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <cmath>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Coord;

// The cells that hold a box and a margin, whole voxels.
CellLattice cellsAround(const BBoxd& bounds, double voxelSize) {
    CellLattice cells;
    cells.side = WindingRows::kSide * voxelSize;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor(bounds.min()[axis] / voxelSize) - 1;
        const double high = std::floor(bounds.max()[axis] / voxelSize) + 2;
        cells.origin[axis] = low * voxelSize;
        cells.count[axis] = static_cast<int>(std::ceil((high - low) / WindingRows::kSide));
    }
    return cells;
}

}  // namespace

WindingRows::WindingRows(const WindingTree& tree, const BBoxd& bounds, const RowLattice& lattice,
                         Progress& progress)
    : mLattice(lattice),
      mCells(cellsAround(bounds, lattice.voxelSize)),
      mXOrigin(std::round(mCells.origin.x() / lattice.voxelSize)) {
    for (int axis = 0; axis < 3; ++axis) {
        mFirstVoxel[axis] = static_cast<int>(std::round(mCells.origin[axis] / lattice.voxelSize));
    }
    const WindingMap map(tree, mCells, progress);
    const std::int64_t count = std::int64_t(mCells.count.y()) * mCells.count.z();
    // A row enters and leaves an ordinary object about once.
    constexpr double kBytesPerRow = 3 * sizeof(float);
    requireMemory(static_cast<double>(count) * kSide * kSide * mLattice.rowCount() * kBytesPerRow,
                  "the rows through the mesh");
    mBundles.resize(count);
    std::vector<std::int64_t> evaluations(count);
    const ProgressStage stage(progress, "rows", count);
    parallelFor(count, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        BundleMarch march(tree, map, bounds, {mLattice, firstVoxel(i), mXOrigin},
                          Coord(0, static_cast<int>(i / mCells.count.z()),
                                static_cast<int>(i % mCells.count.z())));
        march.run(mBundles[i].start, mBundles[i].crossings);
        evaluations[i] = march.evaluations();
        progress.advance();
    });
    for (const std::int64_t e : evaluations) mEvaluations += e;
}

Coord WindingRows::firstVoxel(std::int64_t bundle) const {
    const auto y = static_cast<int>(bundle / mCells.count.z());
    const auto z = static_cast<int>(bundle % mCells.count.z());
    return mFirstVoxel + Coord(0, y * kSide, z * kSide);
}

std::span<const float> WindingRows::rowOfVoxel(int y, int z) const {
    const int fromY = y - mFirstVoxel.y(), fromZ = z - mFirstVoxel.z();
    if (fromY < 0 || fromZ < 0) return {};
    const int bundleY = fromY / kSide, bundleZ = fromZ / kSide;
    if (bundleY >= mCells.count.y() || bundleZ >= mCells.count.z()) return {};
    return row(std::int64_t(bundleY) * mCells.count.z() + bundleZ, fromY % kSide, fromZ % kSide, 0);
}

void WindingRows::subtract(const Mesh& solid, Progress& progress) {
    const RowIntervals inside(solid);
    const ProgressStage stage(progress, "subtract solid", std::ssize(mBundles));
    parallelFor(std::ssize(mBundles), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        progress.advance();
        if (isEmpty(i)) return;
        Bundle rest;
        const Coord first = firstVoxel(i);
        for (int voxel = 0; voxel < kSide * kSide; ++voxel) {
            const int y = voxel / kSide, z = voxel % kSide;
            for (int k = 0; k < mLattice.rowCount(); ++k) {
                const RowLattice::Place& place = mLattice.rows[k];
                rest.start.push_back(static_cast<std::uint32_t>(rest.crossings.size()));
                inside.subtractFrom(
                    row(i, y, z, k),
                    {mLattice.voxelSize * (first.y() + y + place.y),
                     mLattice.voxelSize * (first.z() + z + place.z), mXOrigin, mLattice.voxelSize},
                    rest.crossings);
            }
        }
        rest.start.push_back(static_cast<std::uint32_t>(rest.crossings.size()));
        mBundles[i] = std::move(rest);
    });
}

}  // namespace bandvox

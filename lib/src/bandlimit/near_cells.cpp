#include "bandlimit/near_cells.h"

#include "core/instruction_sets.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// Quadrature points of a large element may lie this far apart, voxels; between them the surface
// is unmarked.
constexpr int kSampleGap = 3;

// Adds what is marked, shifted both ways.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void addShifted(const std::uint8_t* marked, std::size_t count, std::size_t shift,
                std::uint8_t* sum) {
    for (std::size_t i = 0; i + shift < count; ++i) sum[i + shift] |= marked[i];
    for (std::size_t i = 0; i + shift < count; ++i) sum[i] |= marked[i + shift];
}

}  // namespace

NearCells::NearCells(int halo, int interior)
    : mReach((halo + kSampleGap + kCell - 1) / kCell + 1),
      mCount((interior + kCell - 1) / kCell),
      mSide(mCount + 2 * mReach),
      mMarked(static_cast<std::size_t>(mSide) * mSide * mSide),
      mDilated(mMarked.size()) {}

void NearCells::mark(std::span<const SurfaceSample> samples, const openvdb::Vec3d& interiorAt) {
    clear();
    const openvdb::Vec3f shift(openvdb::Vec3d(mReach * kCell) - interiorAt);
    for (const SurfaceSample& sample : samples) {
        std::size_t index = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int cell =
                static_cast<int>((sample.position[axis] + shift[axis]) * (1.0F / kCell));
            index = index * mSide + std::clamp(cell, 0, mSide - 1);
        }
        mMarked[index] = 1;
    }
    widen();
}

void NearCells::clear() {
    std::fill(mMarked.begin(), mMarked.end(), std::uint8_t{0});
}

void NearCells::add(const openvdb::Coord& voxel) {
    std::size_t index = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int cell = (voxel[axis] + mReach * kCell) / kCell;  // not below 0
        index = index * mSide + std::clamp(cell, 0, mSide - 1);
    }
    mMarked[index] = 1;
}

void NearCells::widen() {
    dilate(1);
    dilate(mSide);
    dilate(static_cast<std::size_t>(mSide) * mSide);
}

// Widens what is marked by mReach cells along the axis of that stride.
void NearCells::dilate(std::size_t stride) {
    mDilated = mMarked;
    for (int step = 1; step <= mReach; ++step) {
        // A shift across the border of a row marks cells that are far; that costs a little work
        // and changes nothing in what is stored.
        const std::size_t shift = step * stride;
        addShifted(mMarked.data(), mMarked.size(), shift, mDilated.data());
    }
    mMarked.swap(mDilated);
}

}  // namespace bandvox

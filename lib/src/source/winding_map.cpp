#include "source/winding_map.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::Vec3d;

constexpr int kTaskCells = 8;  // side of the block that a task divides

// What the moments' sum may be off by, and a little more.
constexpr double kDoubt = 0.01;

}  // namespace

// A cube of cells: a power of two along each side, beyond the lattice's end as well.
struct WindingMap::Block {
    Coord first;
    int side;

    BBoxd box(const CellLattice& cells) const {
        const Vec3d low = cells.origin + cells.side * first.asVec3d();
        return {low, low + Vec3d(side * cells.side)};
    }
};

WindingMap::WindingMap(const WindingTree& tree, const CellLattice& cells, Progress& progress)
    : mTree(tree), mCells(cells) {
    const Coord& count = mCells.count;
    const double size = static_cast<double>(count.x()) * count.y() * count.z();
    requireMemory(size * (sizeof(State) + sizeof(float)), "the map of the winding number");
    mState.resize(static_cast<std::size_t>(size));
    mWinding.resize(mState.size());

    const auto blocks = [](int cellsAlong) { return (cellsAlong + kTaskCells - 1) / kTaskCells; };
    const Coord tasks(blocks(count.x()), blocks(count.y()), blocks(count.z()));
    const std::int64_t taskCount = std::int64_t(tasks.x()) * tasks.y() * tasks.z();
    const ProgressStage stage(progress, "winding numbers", taskCount);
    parallelFor(taskCount, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const Coord task(static_cast<int>(i / tasks.z() / tasks.y()),
                         static_cast<int>(i / tasks.z() % tasks.y()),
                         static_cast<int>(i % tasks.z()));
        WindingTerms terms;
        divide({Coord(task.x() * kTaskCells, task.y() * kTaskCells, task.z() * kTaskCells),
                kTaskCells},
               terms);
        progress.advance();
    });
}

// Fills a block, in parts where it is not constant.
void WindingMap::divide(const Block& block, WindingTerms& terms) {
    for (int axis = 0; axis < 3; ++axis) {
        if (block.first[axis] >= mCells.count[axis]) return;
    }
    const BBoxd box = block.box(mCells);
    const WindingRegion region{box.getCenter(), 0.5 * box.extents().length()};
    if (!mTree.mayMeet(box)) {
        mTree.collect({region.center, 0.5 * region.radius}, kFarAway, terms);
        const double winding = terms.at(region.center);
        const double margin = std::abs(winding - kInside) - kDoubt;
        if (margin > 0 &&
            mTree.gradientBound(region, margin / region.radius) * region.radius < margin) {
            fill(block, winding > kInside ? State::Inside : State::Outside, winding);
            return;
        }
    }
    if (block.side == 1) {
        fill(block, State::Mixed, 0);
        return;
    }
    const int half = block.side / 2;
    for (int child = 0; child < 8; ++child) {
        divide(
            {block.first + Coord((child >> 2) * half, (child >> 1 & 1) * half, (child & 1) * half),
             half},
            terms);
    }
}

void WindingMap::fill(const Block& block, State state, double winding) {
    const Coord end = Coord::minComponent(block.first + Coord(block.side), mCells.count);
    for (Coord cell = block.first; cell.x() < end.x(); ++cell.x()) {
        for (cell.y() = block.first.y(); cell.y() < end.y(); ++cell.y()) {
            for (cell.z() = block.first.z(); cell.z() < end.z(); ++cell.z()) {
                mState[mCells.index(cell)] = state;
                mWinding[mCells.index(cell)] = static_cast<float>(winding);
            }
        }
    }
}

}  // namespace bandvox

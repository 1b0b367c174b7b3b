#include "render/screen_cells.h"

#include "core/worker_pool.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

namespace bandvox {

namespace {

// What rounding may do to places, relative.
constexpr double kPlaceRounding = 1e-6;

int cellsAlong(int pixels, int side) {
    return (pixels + side - 1) / side;
}

// From the middle of a block to its farthest corner, world units.
double blockRadius(const openvdb::Mat4d& toWorld) {
    double radius = 0;
    // Four of the corners are as far as their opposites.
    for (int i = 0; i < 4; ++i) {
        const openvdb::Vec3d corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, 1);
        const openvdb::Vec3d half = 0.5 * SurfaceBlocks::kSide * corner;
        radius = std::max(radius, toWorld.transform3x3(half).length());
    }
    return radius * (1 + kPlaceRounding);
}

}  // namespace

ScreenCells::ScreenCells(const Camera& camera, int width, int height, double margin,
                         const SurfaceBlocks& blocks, const openvdb::math::Transform& transform,
                         const Progress& progress)
    : mCamera(camera),
      mWidth(width),
      mHeight(height),
      mMargin(margin),
      mAcross(cellsAlong(width, kSide)),
      mDown(cellsAlong(height, kSide)),
      mToWorld(transform.baseMap()->getAffineMap()->getMat4()),
      mBlockRadius(blockRadius(mToWorld)),
      mCells(static_cast<std::size_t>(mAcross) * mDown) {
    const std::vector<SurfaceBlocks::Group> groups = blocks.groups(progress);
    WorkerPool<Cells> workers([this] { return std::make_unique<Cells>(mCells.size()); });
    constexpr std::size_t kGroupsPerTask = 64;
    const std::size_t tasks = (groups.size() + kGroupsPerTask - 1) / kGroupsPerTask;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        auto cells = workers.take();
        const std::size_t begin = static_cast<std::size_t>(task) * kGroupsPerTask;
        const std::size_t end = std::min(begin + kGroupsPerTask, groups.size());
        for (std::size_t i = begin; i < end; ++i) coverGroup(groups[i], *cells);
        workers.giveBack(std::move(cells));
    });
    for (const auto& cells : workers.idle()) {
        for (std::size_t i = 0; i < mCells.size(); ++i) {
            mCells[i].near = std::min(mCells[i].near, (*cells)[i].near);
            mCells[i].far = std::max(mCells[i].far, (*cells)[i].far);
        }
    }
}

// Marks the cells in which a group can be seen, in cubes of as many blocks as are not much wider
// than a cell.
void ScreenCells::coverGroup(const SurfaceBlocks::Group& group, Cells& cells) const {
    const auto middleOf = [&](const openvdb::Vec3d& first, int side) {
        return mToWorld.transform(first + openvdb::Vec3d(0.5 * side * SurfaceBlocks::kSide));
    };
    const openvdb::Vec3d first = group.first.asVec3d();
    int side = group.side;
    constexpr double kWidest = 2;  // cells
    if (group.rows) {
        const double nearest = mCamera.depth(middleOf(first, side)) - side * mBlockRadius;
        const auto isWide = [&](int blocks) {
            return !(nearest > 0) ||
                   2 * blocks * mBlockRadius * mCamera.pixelsPerLength(nearest) > kWidest * kSide;
        };
        while (side > 1 && isWide(side)) side /= 2;
    }
    // Places of a row of as many blocks along z.
    const std::uint64_t row = (std::uint64_t(1) << std::min(side, 8)) - 1;
    for (int x = 0; x < group.side; x += side) {
        for (int y = 0; y < group.side; y += side) {
            for (int z = 0; z < group.side; z += side) {
                std::uint64_t found = group.rows ? 0 : 1;
                for (int i = x; group.rows && i < x + side; ++i) {
                    for (int j = y; j < y + side; ++j) found |= group.rows[i] >> (8 * j + z) & row;
                }
                if (found == 0) continue;
                const openvdb::Vec3d corner =
                    first + SurfaceBlocks::kSide * openvdb::Vec3d(x, y, z);
                cover(middleOf(corner, side), side * mBlockRadius, cells);
            }
        }
    }
}

void ScreenCells::widen(Span& cell, double near, double far) {
    cell.near = std::min(cell.near, std::nextafter(static_cast<float>(near), 0.0F));
    cell.far = std::max(cell.far,
                        std::nextafter(static_cast<float>(far), std::numeric_limits<float>::max()));
}

// Marks the cells in which a ball can be seen.
void ScreenCells::cover(const openvdb::Vec3d& middle, double radius, Cells& cells) const {
    const double depth = mCamera.depth(middle);
    const bool perspective = mCamera.projection() == CameraOptions::Projection::Perspective;
    if (depth + radius < 0) return;
    const double distance = perspective ? (middle - mCamera.eye()).length() : depth;
    const double near = std::max(distance - radius, 0.0), far = distance + radius;
    if (perspective && !(depth > 2 * radius)) {
        // Around the eye a ball may be seen anywhere.
        for (Span& cell : cells) widen(cell, near, far);
        return;
    }
    // Seen under perspective away from its middle, a ball is longer than in the middle: the plane
    // that it is projected to is at its nearest depth, and it lies askew.
    const openvdb::Vec2d place = mCamera.project(middle);
    const double askew = perspective ? distance / depth : 1;
    const double reach =
        radius * mCamera.pixelsPerLength(depth - (perspective ? radius : 0)) * askew * askew +
        mMargin;
    const int left = static_cast<int>(std::clamp(std::floor(place[0] - reach), 0.0, 1.0 * mWidth));
    const int right =
        static_cast<int>(std::clamp(std::floor(place[0] + reach), -1.0, mWidth - 1.0));
    const int top = static_cast<int>(std::clamp(std::floor(place[1] - reach), 0.0, 1.0 * mHeight));
    const int bottom =
        static_cast<int>(std::clamp(std::floor(place[1] + reach), -1.0, mHeight - 1.0));
    if (left > right || top > bottom) return;
    for (int row = top / kSide; row <= bottom / kSide; ++row) {
        for (int column = left / kSide; column <= right / kSide; ++column) {
            widen(cells[static_cast<std::size_t>(row) * mAcross + column], near, far);
        }
    }
}

}  // namespace bandvox

#include "render/screen_cells.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// What rounding may do to places, relative.
constexpr double kPlaceRounding = 1e-6;

int cellsAlong(int pixels, int side) {
    return (pixels + side - 1) / side;
}

}  // namespace

ScreenCells::ScreenCells(const Camera& camera, int width, int height, double margin,
                         const SurfaceBlocks& blocks, const openvdb::math::Transform& transform)
    : mCamera(camera),
      mWidth(width),
      mHeight(height),
      mMargin(margin),
      mAcross(cellsAlong(width, kSide)),
      mDown(cellsAlong(height, kSide)),
      mCells(static_cast<std::size_t>(mAcross) * mDown) {
    blocks.forEachBlock([&](const openvdb::CoordBBox& box) {
        // A block holds the places from its first voxel on up to the next block's.
        const openvdb::Vec3d low = box.min().asVec3d();
        const openvdb::Vec3d high = box.max().offsetBy(1).asVec3d();
        const openvdb::Vec3d middle = transform.indexToWorld(0.5 * (low + high));
        // The farthest of the corners, of which four are as far as their opposites.
        double radius = 0;
        for (int i = 0; i < 4; ++i) {
            const openvdb::Vec3d corner((i & 1) != 0 ? high[0] : low[0],
                                        (i & 2) != 0 ? high[1] : low[1], high[2]);
            radius = std::max(radius, (transform.indexToWorld(corner) - middle).length());
        }
        cover(middle, radius * (1 + kPlaceRounding));
    });
}

void ScreenCells::widen(Span& cell, double near, double far) {
    cell.near = std::min(cell.near, std::nextafter(static_cast<float>(near), 0.0F));
    cell.far = std::max(cell.far,
                        std::nextafter(static_cast<float>(far), std::numeric_limits<float>::max()));
}

// Marks the cells in which a ball can be seen.
void ScreenCells::cover(const openvdb::Vec3d& middle, double radius) {
    const double depth = mCamera.depth(middle);
    const bool perspective = mCamera.projection() == CameraOptions::Projection::Perspective;
    if (depth + radius < 0) return;
    const double distance = perspective ? (middle - mCamera.eye()).length() : depth;
    const double near = std::max(distance - radius, 0.0), far = distance + radius;
    if (perspective && !(depth > 2 * radius)) {
        // Around the eye a ball may be seen anywhere.
        for (Span& cell : mCells) widen(cell, near, far);
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
            widen(mCells[static_cast<std::size_t>(row) * mAcross + column], near, far);
        }
    }
}

}  // namespace bandvox

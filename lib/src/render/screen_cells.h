#pragma once

#include "render/surface_blocks.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace bandvox {

/// Where in a picture, and how far away, an object's blocks can be seen at all. Most lines of sight
/// pass by an object: they are told so without a look at its tree.
class ScreenCells {
  public:
    /// `margin`: by how many pixels a line of sight may pass outside of its pixel. Throws
    /// Error(ErrorKind::Interrupted) if the caller wants to stop.
    ScreenCells(const Camera& camera, int width, int height, double margin,
                const SurfaceBlocks& blocks, const openvdb::math::Transform& transform,
                const Progress& progress = silentProgress());

    /// Part of a line of sight, world units from where it begins; empty if near > far.
    struct Span {
        float near = std::numeric_limits<float>::max();
        float far = 0;
        bool empty() const { return near > far; }
    };

    /// The part of the lines of sight through a pixel in which blocks can lie.
    const Span& span(int column, int row) const {
        return mCells[static_cast<std::size_t>(row / kSide) * mAcross + column / kSide];
    }

  private:
    static constexpr int kSide = 8;  // pixels

    using Cells = std::vector<Span>;

    void coverGroup(const SurfaceBlocks::Group& group, Cells& cells) const;
    void cover(const openvdb::Vec3d& middle, double radius, Cells& cells) const;
    static void widen(Span& cell, double near, double far);

    const Camera& mCamera;
    int mWidth, mHeight;
    double mMargin;
    int mAcross, mDown;  // cells
    openvdb::Mat4d mToWorld;
    double mBlockRadius;  // world units
    Cells mCells;
};

}  // namespace bandvox

#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/camera.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/render/image.h>

#include <openvdb/Types.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace bandvox {

/// Where in a pixel, [0, 1)², its lines of sight pass: rows of evenly spaced places.
std::vector<openvdb::Vec2d> samplePlaces(int samples);

/// A picture of `grid` in which nothing is seen yet. Throws Error(ErrorKind::Memory) before
/// allocating if it would not fit.
Image blankImage(const RenderOptions& options, double iso, const openvdb::GridBase& grid);

/// The picture of a grid of which nothing is to be seen.
RenderResult emptyPicture(const RenderOptions& options, double iso, const openvdb::GridBase& grid);

/// What a line of sight meets.
struct Sight {
    double depth;
    openvdb::Vec3d position, normal;  ///< world
};

/// Sets what is seen at a pixel, but for its colour.
void setSight(Image& image, std::size_t pixel, const Sight& sight);

/// Sets a pixel's colour: `light` is the sum of its lines of sight, `hits` of which met something.
void setColor(Image& image, std::size_t pixel, const openvdb::Vec3d& light, int hits,
              const RenderOptions& options);

/// How a surface is lit.
class Lighting {
  public:
    Lighting(const RenderOptions& options, const Camera& camera);

    /// Lambert's cosine law; `normal`: world, unit.
    openvdb::Vec3d shade(const openvdb::Vec3d& normal) const;

    /// A surface that reflects this part of the light, 0 to 1, whatever its normal.
    openvdb::Vec3d tone(double reflected) const;

  private:
    openvdb::Vec3d mColor, mLight;
    double mAmbient;
};

/// Columns [left, right) and rows [top, bottom) of a picture.
struct PixelBox {
    int left, top, right, bottom;

    /// Calls `visit(column, row)` for each pixel. Stops between rows if the caller wants to:
    /// throws Error(ErrorKind::Interrupted).
    template <typename Visitor>
    void forEach(const Progress& progress, const Visitor& visit) const {
        for (int row = top; row < bottom; ++row) {
            progress.throwIfInterrupted();
            for (int column = left; column < right; ++column) visit(column, row);
        }
    }
};

/// Calls `body` for each tile of a picture, in parallel; advances `progress` after each.
void forEachTile(int width, int height, Progress& progress,
                 const std::function<void(const PixelBox&)>& body);

/// How many tiles that are.
std::int64_t tileCount(int width, int height);

}  // namespace bandvox

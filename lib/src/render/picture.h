#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/camera.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/render/image.h>

#include <openvdb/Types.h>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace bandvox {

/// Where the lines of sight of a pixel, [0, 1)², pass, or, under a filter that reaches farther,
/// around it: rows of evenly spaced places, drawn closer where the filter weighs more.
std::vector<openvdb::Vec2d> samplePlaces(int samples, PixelFilter filter = PixelFilter::Box);

/// The part of the picture that is drawn: all of it, or the crop window.
CropWindow drawnPart(const PictureOptions& options);

/// A picture, or the part of it that is drawn, in which nothing is seen yet. Throws
/// Error(ErrorKind::Memory) before allocating if it would not fit.
Image blankImage(const PictureOptions& options);

/// Says of a picture what it was made of and how: names after bandvox, and those that other
/// programs look for.
void describe(Image& image, const openvdb::GridBase& grid, double iso);
void describe(Image& image, const PictureOptions& options, const Camera& camera);

/// The picture of something of which nothing is to be seen.
RenderResult emptyPicture(const PictureOptions& options);

/// What a line of sight meets.
struct Sight {
    double depth;
    openvdb::Vec3d position, normal;  ///< world
};

/// Sets what is seen at a pixel, but for its colour.
void setSight(Image& image, std::size_t pixel, const Sight& sight);

/// Sets a pixel's colour: `light` is the sum of its lines of sight, `hits` of which met something,
/// parts counted as such.
void setColor(Image& image, std::size_t pixel, const openvdb::Vec3d& light, double hits,
              const PictureOptions& options);

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

/// The tiles of a picture.
std::vector<PixelBox> tilesOf(int width, int height);

/// Calls `body` for each tile, in parallel; advances `progress` after each.
void forEachTile(std::span<const PixelBox> tiles, Progress& progress,
                 const std::function<void(const PixelBox&)>& body);
void forEachTile(int width, int height, Progress& progress,
                 const std::function<void(const PixelBox&)>& body);

/// How many tiles that are.
std::int64_t tileCount(int width, int height);

}  // namespace bandvox

#include "render/picture.h"

#include "render/filter_places.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

namespace bandvox {

namespace {

// Pixels along the side of what one task draws.
constexpr int kImageTile = 32;

std::int64_t tilesAlong(int pixels) {
    return (pixels + kImageTile - 1) / kImageTile;
}

}  // namespace

std::vector<openvdb::Vec2d> samplePlaces(int samples, PixelFilter filter) {
    const FilterPlaces places(filter);
    const int rows = std::max(1, static_cast<int>(std::sqrt(samples + 0.5)));
    std::vector<openvdb::Vec2d> all;
    for (int row = 0; row < rows; ++row) {
        const int columns = samples / rows + (row < samples % rows ? 1 : 0);
        for (int column = 0; column < columns; ++column) {
            all.emplace_back(places((column + 0.5) / columns), places((row + 0.5) / rows));
        }
    }
    return all;
}

CropWindow drawnPart(const PictureOptions& options) {
    return options.crop.value_or(CropWindow{0, 0, options.width, options.height});
}

Image blankImage(const PictureOptions& options) {
    const CropWindow part = drawnPart(options);
    Image image;
    image.width = part.right - part.left;
    image.height = part.bottom - part.top;
    const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
    requireMemory(11.0 * sizeof(float) * static_cast<double>(pixels), "the picture");
    if (options.crop) {
        image.left = part.left;
        image.top = part.top;
        image.fullWidth = options.width;
        image.fullHeight = options.height;
    }
    image.color.assign(4 * pixels, 0.0F);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    image.normal.assign(3 * pixels, 0.0F);
    image.position.assign(3 * pixels, 0.0F);
    image.metadata.emplace_back("Software", std::string("Bandvox ") + version());
    image.metadata.emplace_back("bandvox_samples", options.samples);
    image.metadata.emplace_back("bandvox_seed", static_cast<int>(options.seed));
    return image;
}

void describe(Image& image, const openvdb::GridBase& grid, double iso) {
    image.metadata.emplace_back("bandvox_iso", iso);
    const std::string source = sourceOf(grid);
    if (!source.empty()) image.metadata.emplace_back("bandvox_source", source);
}

void describe(Image& image, const PictureOptions& options, const Camera& camera) {
    const bool perspective = camera.projection() == CameraOptions::Projection::Perspective;
    image.metadata.emplace_back("bandvox_camera",
                                std::string(perspective ? "perspective" : "orthographic"));
    for (const auto& [name, v] :
         {std::pair{"bandvox_eye", camera.eye()}, std::pair{"bandvox_forward", camera.forward()},
          std::pair{"bandvox_up", camera.upward()}}) {
        std::ostringstream text;
        text << std::setprecision(9) << v[0] << ',' << v[1] << ',' << v[2];
        image.metadata.emplace_back(name, text.str());
    }
    if (perspective) {
        image.metadata.emplace_back("bandvox_focal", options.camera.focal);
        image.metadata.emplace_back("bandvox_aperture", options.camera.aperture);
    }
    image.metadata.emplace_back("worldToCamera", camera.worldToCamera());
    image.metadata.emplace_back("worldToNDC", camera.worldToScreen());
}

void setSight(Image& image, std::size_t pixel, const Sight& sight) {
    image.depth[pixel] = static_cast<float>(sight.depth);
    for (int c = 0; c < 3; ++c) {
        image.normal[3 * pixel + c] = static_cast<float>(sight.normal[c]);
        image.position[3 * pixel + c] = static_cast<float>(sight.position[c]);
    }
}

void setColor(Image& image, std::size_t pixel, const openvdb::Vec3d& light, double hits,
              const PictureOptions& options) {
    const double coverage = hits / options.samples;
    openvdb::Vec3d color = light / options.samples;
    if (options.background) color += (1 - coverage) * *options.background;
    for (int c = 0; c < 3; ++c) image.color[4 * pixel + c] = static_cast<float>(color[c]);
    image.color[4 * pixel + 3] = options.background ? 1.0F : static_cast<float>(coverage);
}

RenderResult emptyPicture(const PictureOptions& options) {
    RenderResult result;
    result.image = blankImage(options);
    for (std::size_t i = 0; i < result.image.depth.size(); ++i) {
        setColor(result.image, i, openvdb::Vec3d(0.0), 0, options);
    }
    result.rays = static_cast<std::int64_t>(result.image.depth.size()) * options.samples;
    return result;
}

Lighting::Lighting(const RenderOptions& options, const Camera& camera)
    : mColor(options.color), mAmbient(options.ambient) {
    const openvdb::Vec3d& light = options.light;
    mLight = (light[0] * camera.right() + light[1] * camera.upward() - light[2] * camera.forward())
                 .unit();
}

openvdb::Vec3d Lighting::shade(const openvdb::Vec3d& normal) const {
    return tone(std::max(normal.dot(mLight), 0.0));
}

openvdb::Vec3d Lighting::tone(double reflected) const {
    return mColor * (mAmbient + (1 - mAmbient) * reflected);
}

std::vector<PixelBox> tilesOf(int width, int height) {
    std::vector<PixelBox> tiles;
    for (int top = 0; top < height; top += kImageTile) {
        for (int left = 0; left < width; left += kImageTile) {
            tiles.push_back({left, top, std::min(left + kImageTile, width),
                             std::min(top + kImageTile, height)});
        }
    }
    return tiles;
}

void forEachTile(std::span<const PixelBox> tiles, Progress& progress,
                 const std::function<void(const PixelBox&)>& body) {
    parallelFor(static_cast<std::int64_t>(tiles.size()), [&](std::int64_t tile) {
        progress.throwIfInterrupted();
        body(tiles[tile]);
        progress.advance();
    });
}

void forEachTile(int width, int height, Progress& progress,
                 const std::function<void(const PixelBox&)>& body) {
    forEachTile(tilesOf(width, height), progress, body);
}

std::int64_t tileCount(int width, int height) {
    return tilesAlong(width) * tilesAlong(height);
}

}  // namespace bandvox

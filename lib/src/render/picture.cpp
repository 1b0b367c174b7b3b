#include "render/picture.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace bandvox {

namespace {

// Pixels along the side of what one task draws.
constexpr int kImageTile = 32;

std::int64_t tilesAlong(int pixels) {
    return (pixels + kImageTile - 1) / kImageTile;
}

}  // namespace

std::vector<openvdb::Vec2d> samplePlaces(int samples) {
    const int rows = std::max(1, static_cast<int>(std::sqrt(samples + 0.5)));
    std::vector<openvdb::Vec2d> places;
    for (int row = 0; row < rows; ++row) {
        const int columns = samples / rows + (row < samples % rows ? 1 : 0);
        for (int column = 0; column < columns; ++column) {
            places.emplace_back((column + 0.5) / columns, (row + 0.5) / rows);
        }
    }
    return places;
}

Image blankImage(const RenderOptions& options, double iso, const openvdb::GridBase& grid) {
    const std::size_t pixels = static_cast<std::size_t>(options.width) * options.height;
    requireMemory(11.0 * sizeof(float) * static_cast<double>(pixels), "the picture");
    Image image;
    image.width = options.width;
    image.height = options.height;
    image.color.assign(4 * pixels, 0.0F);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    image.normal.assign(3 * pixels, 0.0F);
    image.position.assign(3 * pixels, 0.0F);
    std::ostringstream isoText;
    isoText << iso;
    image.metadata = {{"Software", std::string("Bandvox ") + version()},
                      {"bandvox_iso", isoText.str()}};
    const std::string source = sourceOf(grid);
    if (!source.empty()) image.metadata.emplace_back("bandvox_source", source);
    return image;
}

void setSight(Image& image, std::size_t pixel, const Sight& sight) {
    image.depth[pixel] = static_cast<float>(sight.depth);
    for (int c = 0; c < 3; ++c) {
        image.normal[3 * pixel + c] = static_cast<float>(sight.normal[c]);
        image.position[3 * pixel + c] = static_cast<float>(sight.position[c]);
    }
}

void setColor(Image& image, std::size_t pixel, const openvdb::Vec3d& light, int hits,
              const RenderOptions& options) {
    const double coverage = double(hits) / options.samples;
    openvdb::Vec3d color = light / options.samples;
    if (options.background) color += (1 - coverage) * *options.background;
    for (int c = 0; c < 3; ++c) image.color[4 * pixel + c] = static_cast<float>(color[c]);
    image.color[4 * pixel + 3] = options.background ? 1.0F : static_cast<float>(coverage);
}

RenderResult emptyPicture(const RenderOptions& options, double iso, const openvdb::GridBase& grid) {
    RenderResult result;
    result.image = blankImage(options, iso, grid);
    for (std::size_t i = 0; i < result.image.depth.size(); ++i) {
        setColor(result.image, i, openvdb::Vec3d(0.0), 0, options);
    }
    result.rays = std::int64_t(options.width) * options.height * options.samples;
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

void forEachTile(int width, int height, Progress& progress,
                 const std::function<void(const PixelBox&)>& body) {
    const std::int64_t across = tilesAlong(width);
    parallelFor(tileCount(width, height), [&](std::int64_t tile) {
        progress.throwIfInterrupted();
        const int left = static_cast<int>(tile % across) * kImageTile;
        const int top = static_cast<int>(tile / across) * kImageTile;
        body({left, top, std::min(left + kImageTile, width), std::min(top + kImageTile, height)});
        progress.advance();
    });
}

std::int64_t tileCount(int width, int height) {
    return tilesAlong(width) * tilesAlong(height);
}

}  // namespace bandvox

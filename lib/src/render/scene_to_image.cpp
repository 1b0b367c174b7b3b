#include "core/worker_pool.h"
#include "render/filter_places.h"
#include "render/light_paths.h"
#include "render/picture.h"
#include "render/picture_request.h"
#include "render/prepared_scene.h"
#include "render/screen_cells.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/render/scene_to_image.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

namespace bandvox {

namespace {

using openvdb::Vec2d;
using openvdb::Vec3d;

// Of a preview's first, coarse picture: pixels along the side of what is drawn as one.
constexpr int kCoarse = 8;

// A picture that is shown while it is drawn is drawn in so many parts.
constexpr int kPreviewParts = 64;

// Volumes that hide less than this of what is behind are not seen.
constexpr double kLeastCoverage = 1e-3;

Camera makeCamera(const Scene& scene, const PictureOptions& options, const Progress& progress) {
    FramedPoints framed;
    if (needsFraming(options.camera)) {
        framed = pointsToFrame(scene, progress);
    } else {
        framed.active = {*options.camera.lookat};
    }
    return Camera(options.camera, options.width, options.height, framed.active, framed.faint);
}

// Draws pixels, from many threads.
class Painter {
  public:
    Painter(const PreparedScene& scene, const LightPaths& paths, const Camera& camera,
            const PictureOptions& options, Image& image, const Progress& progress)
        : mPaths(paths),
          mCamera(camera),
          mOptions(options),
          mImage(image),
          mPlaces(samplePlaces(options.samples, options.filter)),
          mProbes([&scene] { return std::make_unique<SceneProbes>(scene.probes()); }),
          mIsEmptyAround(scene.volumes().empty() && !scene.environment().visible) {
        const double margin = filterRadius(options.filter) - 0.5;
        for (const auto& surface : scene.surfaces()) {
            mCells.push_back(std::make_unique<ScreenCells>(camera, options.width, options.height,
                                                           margin, surface->blocks(),
                                                           surface->grid().transform(), progress));
        }
    }

    // Draws the pixels of a tile, or of the coarse picture one in so many.
    void draw(const PixelBox& tile, int every, Progress& progress) {
        std::unique_ptr<SceneProbes> probes = mProbes.take();
        std::int64_t hits = 0;
        for (int row = tile.top; row < tile.bottom; row += every) {
            for (int column = tile.left; column < tile.right; column += every) {
                progress.throwIfInterrupted();
                hits += draw(column, row, *probes);
                if (every > 1) spread(tile, column, row, every);
            }
        }
        mProbes.giveBack(std::move(probes));
        if (every == 1) mHits += hits;
    }

    std::int64_t hits() const { return mHits; }

  private:
    // Draws a pixel of the image. Returns how many of its lines of sight meet something.
    int draw(int column, int row, SceneProbes& probes) {
        const std::size_t pixel = static_cast<std::size_t>(row) * mImage.width + column;
        const int pictureColumn = mImage.left + column, pictureRow = mImage.top + row;
        std::array<ScreenCells::Span, kMostSurfaces> spans;
        bool isEmpty = mIsEmptyAround;
        for (std::size_t i = 0; i < mCells.size(); ++i) {
            spans[i] = mCells[i]->span(pictureColumn, pictureRow);
            isEmpty = isEmpty && spans[i].empty();
        }
        const Sight nothing{std::numeric_limits<double>::infinity(), Vec3d(0.0), Vec3d(0.0)};
        if (isEmpty) {
            setColor(mImage, pixel, Vec3d(0.0), 0, mOptions);
            setSight(mImage, pixel, nothing);
            return 0;
        }

        Vec3d light(0.0);
        double coverage = 0;
        int hits = 0;
        std::optional<Sight> nearest;
        double mediumDepth = 0, mediumWeight = 0;
        for (std::size_t s = 0; s < mPlaces.size(); ++s) {
            const Ray ray = mCamera.ray(pictureColumn + mPlaces[s][0], pictureRow + mPlaces[s][1]);
            SampleStream numbers(mOptions.seed, static_cast<std::uint32_t>(pictureColumn),
                                 static_cast<std::uint32_t>(pictureRow),
                                 static_cast<std::uint32_t>(s));
            const PathLight seen = mPaths.look(ray, {spans.data(), mCells.size()}, numbers, probes);
            light += seen.light;
            coverage += seen.coverage;
            if (seen.depth < 0) continue;
            if (seen.hit || seen.coverage > kLeastCoverage) ++hits;
            if (seen.hit) {
                const Vec3d position = ray.origin + seen.depth * ray.direction;
                const Sight sight{mCamera.depth(position), position, seen.hit->normal};
                if (!nearest || sight.depth < nearest->depth) nearest = sight;
            } else {
                mediumDepth += seen.coverage * seen.depth;
                mediumWeight += seen.coverage;
            }
        }
        setColor(mImage, pixel, light, coverage, mOptions);
        if (!nearest && mediumWeight > kLeastCoverage) {
            const Ray ray = mCamera.ray(pictureColumn + 0.5, pictureRow + 0.5);
            const Vec3d position = ray.origin + mediumDepth / mediumWeight * ray.direction;
            nearest = Sight{mCamera.depth(position), position, Vec3d(0.0)};
        }
        setSight(mImage, pixel, nearest.value_or(nothing));
        return hits;
    }

    // Copies the pixel in the corner of a coarse one to all of it.
    void spread(const PixelBox& tile, int left, int top, int side) {
        const std::size_t from = static_cast<std::size_t>(top) * mImage.width + left;
        for (int row = top; row < std::min(top + side, tile.bottom); ++row) {
            for (int column = left; column < std::min(left + side, tile.right); ++column) {
                const std::size_t to = static_cast<std::size_t>(row) * mImage.width + column;
                std::copy_n(&mImage.color[4 * from], 4, &mImage.color[4 * to]);
                mImage.depth[to] = mImage.depth[from];
                std::copy_n(&mImage.normal[3 * from], 3, &mImage.normal[3 * to]);
                std::copy_n(&mImage.position[3 * from], 3, &mImage.position[3 * to]);
            }
        }
    }

    static constexpr std::size_t kMostSurfaces = 64;

    const LightPaths& mPaths;
    const Camera& mCamera;
    const PictureOptions& mOptions;
    Image& mImage;
    std::vector<Vec2d> mPlaces;
    std::vector<std::unique_ptr<ScreenCells>> mCells;
    WorkerPool<SceneProbes> mProbes;
    bool mIsEmptyAround;  // nothing is seen beside the surfaces
    std::atomic<std::int64_t> mHits{0};
};

// Draws a picture part by part, from its middle outward, and shows it in between.
void drawWithPreview(Painter& painter, Image& image, const PictureOptions& options,
                     Progress& progress) {
    using Clock = std::chrono::steady_clock;
    std::vector<PixelBox> tiles = tilesOf(image.width, image.height);
    const auto fromMiddle = [&image](const PixelBox& tile) {
        return std::hypot(tile.left + tile.right - image.width,
                          tile.top + tile.bottom - image.height);
    };
    std::stable_sort(tiles.begin(), tiles.end(), [&](const PixelBox& a, const PixelBox& b) {
        return fromMiddle(a) < fromMiddle(b);
    });
    parallelFor(static_cast<std::int64_t>(tiles.size()),
                [&](std::int64_t i) { painter.draw(tiles[i], kCoarse, progress); });
    Clock::time_point shown = Clock::now();
    image.metadata.emplace_back("bandvox_preview", 1);
    options.preview(image);
    const std::size_t part = std::max<std::size_t>(tiles.size() / kPreviewParts, 1);
    for (std::size_t first = 0; first < tiles.size(); first += part) {
        const std::size_t count = std::min(part, tiles.size() - first);
        forEachTile({&tiles[first], count}, progress,
                    [&](const PixelBox& tile) { painter.draw(tile, 1, progress); });
        const std::chrono::duration<double> since = Clock::now() - shown;
        if (first + count < tiles.size() && since.count() >= options.previewSeconds) {
            options.preview(image);
            shown = Clock::now();
        }
    }
    image.metadata.pop_back();
}

// Says why nothing is seen.
[[noreturn]] void failUnseen(const PreparedScene& scene, std::int64_t rays) {
    const bool isUnreached =
        std::all_of(scene.surfaces().begin(), scene.surfaces().end(),
                    [](const auto& surface) { return surface->maximum() < surface->threshold(); });
    if (isUnreached && scene.volumes().empty()) {
        throw Error(ErrorKind::Result, scene.whyEmpty());
    }
    std::ostringstream message;
    message << "nothing to see: none of " << rays << " lines of sight ";
    if (scene.volumes().empty()) {
        message << "meets the surface; expected the camera to face it";
    } else {
        message << "meets a surface, or loses a thousandth of its light in a volume; expected the "
                   "camera to face one, or more extinction";
    }
    throw Error(ErrorKind::Result, message.str());
}

bool isEmpty(const PreparedScene& scene) {
    return std::all_of(scene.surfaces().begin(), scene.surfaces().end(),
                       [](const auto& surface) { return surface->empty(); }) &&
           std::all_of(scene.volumes().begin(), scene.volumes().end(),
                       [](const auto& volume) { return volume->empty(); });
}

}  // namespace

RenderResult sceneToImage(const Scene& scene, const PictureOptions& options, Progress& progress) {
    // Prepare what is to be seen.
    requireValid(options);
    requireValid(scene);
    const PreparedScene prepared(scene, options, progress);
    if (!options.allowEmpty && isEmpty(prepared)) {
        throw Error(ErrorKind::Result, prepared.whyEmpty());
    }
    const bool hasObjects = !prepared.surfaces().empty() || !prepared.volumes().empty();
    // The environment may be seen by a camera that needs no object.
    if (!hasObjects && needsFraming(options.camera)) return emptyPicture(options);
    const Camera camera = makeCamera(scene, options, progress);
    const Lamps lamps(scene.lights, camera);
    const LightPaths paths(prepared, lamps, options, progress);

    // Draw.
    RenderResult result;
    result.image = blankImage(options);
    if (scene.objects.size() == 1 && !prepared.surfaces().empty()) {
        describe(result.image, *scene.objects.front().grid, prepared.surfaces().front()->iso());
    }
    describe(result.image, options, camera);
    Painter painter(prepared, paths, camera, options, result.image, progress);
    {
        Image& image = result.image;
        const ProgressStage stage(progress, "drawing", tileCount(image.width, image.height));
        if (options.preview) {
            drawWithPreview(painter, image, options, progress);
        } else {
            forEachTile(image.width, image.height, progress,
                        [&](const PixelBox& tile) { painter.draw(tile, 1, progress); });
        }
    }
    result.hits = painter.hits();
    result.rays = static_cast<std::int64_t>(result.image.depth.size()) * options.samples;
    if (!options.allowEmpty && result.hits == 0) failUnseen(prepared, result.rays);
    return result;
}

}  // namespace bandvox

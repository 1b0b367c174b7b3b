#include "render/picture_request.h"

#include <bandvox/core/error.h>
#include <bandvox/render/turntable.h>

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <numbers>
#include <string>

namespace bandvox {

using openvdb::Vec3d;

std::vector<CameraOptions> turntable(const Scene& scene, const PictureOptions& options,
                                     int pictures, Progress& progress) {
    constexpr int kMostPictures = 100000;
    if (pictures < 1 || pictures > kMostPictures) {
        throw Error(ErrorKind::Usage, "a turntable of " + std::to_string(pictures) +
                                          " pictures; expected 1 to " +
                                          std::to_string(kMostPictures));
    }
    requireValid(options);
    requireValid(scene);
    const ProgressStage stage(progress, "framing", pictures);
    const auto [points, faint] = pointsToFrame(scene, progress);
    openvdb::BBoxd box;
    for (const Vec3d& point : points) box.expand(point);

    CameraOptions first = options.camera;
    if (!first.lookat) first.lookat = points.empty() ? Vec3d(0.0) : box.getCenter();
    const Vec3d axis = first.up.value_or(Vec3d(0, 1, 0)).unit();
    const Vec3d back = first.eye ? *first.eye - *first.lookat : first.from;
    std::vector<CameraOptions> cameras;
    double farthest = 0, widest = 0;
    for (int i = 0; i < pictures; ++i) {
        progress.throwIfInterrupted();
        const auto turn = openvdb::math::rotation<openvdb::math::Mat3d>(
            axis, 2 * std::numbers::pi * i / pictures);
        CameraOptions camera = first;
        camera.from = turn * back;
        if (first.eye) camera.eye = *first.lookat + camera.from;
        cameras.push_back(camera);
        if (points.empty() || first.eye) continue;
        const Camera framed(camera, options.width, options.height, points, faint);
        farthest = std::max(farthest, (framed.eye() - *first.lookat).length());
        widest = std::max(widest, options.width / framed.pixelsPerLength(1));
        progress.advance();
    }
    if (farthest > 0) {
        for (CameraOptions& camera : cameras) {
            camera.eye = *first.lookat + farthest * camera.from.unit();
            if (camera.projection == CameraOptions::Projection::Orthographic) camera.frame = widest;
        }
    }
    return cameras;
}

}  // namespace bandvox

#pragma once

#include <bandvox/render/camera.h>
#include <bandvox/render/image.h>

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// How the lines of sight around a pixel count for it.
enum class PixelFilter {
    Box,             ///< all alike, within the pixel
    Triangle,        ///< over two pixels
    Gaussian,        ///< over three pixels, standard deviation half a pixel
    BlackmanHarris,  ///< over four pixels
};

/// A word for each, in their order: "box", "triangle", "gaussian", "blackman-harris".
const std::vector<std::string>& pixelFilterNames();

/// A part of a picture: columns [left, right), rows [top, bottom) from the top, pixels.
struct CropWindow {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// How far light is followed.
struct TransportOptions {
    bool shadows = false;  ///< lamps shine only where nothing is in their way
    int gather = 0;  ///< directions per line of sight in which a matt surface looks for light from
                     ///< around; 0: nothing is in its way
    double gatherDistance = 0;  ///< world units beyond which nothing is in its way; 0: any
    int bounces = 0;  ///< how often light goes on from one matt surface to the next, with `gather`
    int depth = 8;    ///< how often a line of sight is mirrored and refracted at most
};

/// How lines of sight go through volumes.
struct VolumeOptions {
    enum class Method {
        Steps,    ///< evenly spaced places; smooth, exact to the band limit
        Tracking  ///< random places, on average exact (delta and ratio tracking)
    } method = Method::Steps;
    double step = 1;  ///< voxels from place to place, 0.05 to 16
};

/// A picture as such, whatever is in it.
struct PictureOptions {
    int width = 1024;   ///< pixels; 1 to 65536
    int height = 1024;  ///< pixels; 1 to 65536
    int samples = 1;    ///< lines of sight per pixel, on a regular grid; ≥ 1
    PixelFilter filter = PixelFilter::Box;
    std::optional<CropWindow> crop;  ///< default: all of it
    std::uint32_t seed = 0;          ///< of all that is random
    CameraOptions camera;
    std::optional<openvdb::Vec3d> background;  ///< linear; default: transparent
    bool allowEmpty = false;                   ///< let nothing be seen, instead of throwing
    TransportOptions transport;
    VolumeOptions volumes;
    double tolerance = 5e-4;   ///< error of what is read between the nodes: of the density, and of
                               ///< the gradient relative to a flat face's; 1e-6 to 0.1
    bool readsFinely = false;  ///< keep to it even if the lattice itself is known less well: what
                               ///< is read then is smoother, but no more exact
    std::size_t cacheBytes = 0;  ///< memory for what is read between the nodes; 0: a quarter of
                                 ///< what is free, at most 2 GiB
    /// Called now and then, from the calling thread, with the picture as far as it is: first
    /// coarse, then tile by tile.
    std::function<void(const Image&)> preview;
    double previewSeconds = 2;  ///< between two calls, at least
};

/// Throws Error(ErrorKind::Usage) for options out of range, as far as that does not depend on what
/// is seen.
void requireValid(const PictureOptions& options);

/// A picture and what it took.
struct RenderResult {
    Image image;
    std::int64_t rays = 0;
    std::int64_t hits = 0;
};

}  // namespace bandvox

#include "render_settings.h"

#include "gltf_camera.h"
#include "words.h"

#include <bandvox/core/error.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox::app {
namespace {

constexpr int kMostPixels = 65536;  // along a side
constexpr int kMostSamples = 1024;
constexpr int kMostBounces = 64;
constexpr int kMostMegabytes = 1 << 20;
const Range kLens{.low = 1e-3, .high = 1e6};  // mm
const std::vector<std::string> kProjections{"perspective", "orthographic"};
const std::vector<std::string> kVolumeMethods{"steps", "tracking"};

// In the order of ImageChannels.
std::vector<std::string> channelNames() {
    return {"color", "depth", "normal", "position"};
}

std::string inWords(const openvdb::Vec3d& v) {
    return formatNumber(v.x()) + "," + formatNumber(v.y()) + "," + formatNumber(v.z());
}

TransportOptions readTransport(const OptionValues& values) {
    TransportOptions transport;
    transport.shadows = values.has("shadows");
    transport.gather = values.wholeNumber("gather", 0, kMostSamples, transport.gather);
    transport.gatherDistance =
        values.number("gather-distance", {.low = 0}, transport.gatherDistance);
    transport.bounces = values.wholeNumber("bounces", 0, kMostBounces, transport.bounces);
    transport.depth = values.wholeNumber("depth", 0, kMostBounces, transport.depth);
    return transport;
}

}  // namespace

CameraOptions readCamera(const OptionValues& values, double aspect) {
    CameraOptions camera;
    if (const auto file = values.text("camera-file")) camera = readGltfCamera(*file, aspect);
    using Projection = CameraOptions::Projection;
    const std::array projections{Projection::Perspective, Projection::Orthographic};
    camera.projection = projections[values.choice(
        "camera", kProjections, camera.projection == Projection::Orthographic ? 1 : 0)];
    if (const auto eye = values.vector("eye", kAnyPlace)) camera.eye = eye;
    if (const auto lookat = values.vector("lookat", kAnyPlace)) camera.lookat = lookat;
    if (const auto up = values.vector("up", kAnyPlace)) camera.up = up;
    camera.from = values.vector("from", kAnyPlace).value_or(camera.from);
    camera.aperture = values.number("aperture", kLens, camera.aperture);
    camera.focal = values.number("focal", kLens, camera.focal);
    const bool hasBoth = values.has("fov") && values.has("focal");
    if (hasBoth && values.isAsked("fov") == values.isAsked("focal")) {
        values.fail("fov", "either this or the focal length, which is given too");
    }
    // What a command asks for comes before what a file says.
    if (values.has("fov") && !(hasBoth && values.isAsked("focal"))) {
        const double degrees =
            values.number("fov", {.low = 0, .high = 180, .lowOpen = true, .highOpen = true}, 45);
        camera.focal = 0.5 * camera.aperture / std::tan(0.5 * degrees * std::numbers::pi / 180);
    }
    const bool isFrameMeant = values.isAsked("frame") || !values.isAsked("camera");
    if (values.has("frame") && isFrameMeant && camera.projection != Projection::Orthographic) {
        values.fail("frame", "--camera orthographic beside it, whose view has this width");
    }
    camera.frame = values.number("frame", {.low = 0}, camera.frame);
    return camera;
}

void requireUsedCamera(const OptionValues& values, const CameraOptions& camera) {
    if (values.isAsked("from") && camera.eye) {
        values.fail("from",
                    "either this direction to an eye that is chosen, or an eye, which is "
                    "given too");
    }
    if (camera.projection != CameraOptions::Projection::Orthographic) return;
    for (const char* const lens : {"focal", "aperture", "fov"}) {
        if (values.isAsked(lens)) {
            values.fail(lens, "a perspective view beside it; --frame is the width of this one");
        }
    }
}

std::vector<OptionEntry> cameraEntries() {
    const CameraOptions camera;
    const std::string view = "Camera";
    return {
        {"camera",
         0,
         "KIND",
         "perspective",
         "perspective or orthographic.",
         view,
         {.words = kProjections}},
        {"camera-file",
         0,
         "FILE",
         "",
         "A .gltf or .glb file with a camera; FILE:NAME takes the one of that name, else it is the "
         "first. The options below change it.",
         view,
         {.endings = {".gltf", ".glb"}}},
        {"eye", 0, "X,Y,Z", "chosen", "Where the camera is, world.", view},
        {"lookat", 0, "X,Y,Z", "the middle", "What it looks at, world.", view},
        {"up", 0, "X,Y,Z", "0,1,0, or z along y", "What is up in the picture.", view},
        {"from", 0, "X,Y,Z", inWords(camera.from),
         "Direction from the object to the camera, if --eye is not given.", view},
        {"focal", 0, "MM", formatNumber(camera.focal), "Focal length in mm (perspective).", view},
        {"aperture", 0, "MM", formatNumber(camera.aperture),
         "Width of the film in mm (perspective).", view},
        {"fov", 0, "DEG", "as focal and aperture",
         "Angle of view from left to right, instead of "
         "--focal.",
         view},
        {"frame", 0, "W", "fits",
         "Width of the view in world units (orthographic); 0 fits the objects.", view},
    };
}

std::vector<OptionEntry> pictureEntries() {
    const PictureOptions options;
    const std::string picture = "Picture";
    const std::string light = "How far light is followed";
    std::vector<OptionEntry> entries{
        {"res", 0, "WxH", std::to_string(options.width) + "x" + std::to_string(options.height),
         "Width and height, pixels.", picture},
        {"samples", 0, "N", std::to_string(options.samples), "Lines of sight per pixel.", picture},
        {"filter",
         0,
         "KIND",
         pixelFilterNames().front(),
         "How they count for the pixel: " + joined(pixelFilterNames(), ", ") + ".",
         picture,
         {.words = pixelFilterNames()}},
        {"crop", 0, "L,T,R,B", "all",
         "Draw a part of the picture: columns L to R and rows T to B, from the upper left corner, "
         "the last ones not included. An .exr says where it belongs.",
         picture},
        {"channels",
         0,
         "LIST",
         joined(channelNames(), ","),
         "What an .exr holds: R G B A, Z, N and P.",
         picture,
         {.words = channelNames(), .isList = true}},
        {"background", 0, "R,G,B", "transparent", "Linear colour behind the objects.", picture},
        {"seed", 0, "N", std::to_string(options.seed), "Of all that is random.", picture},
        {"allow-empty", 0, "", "",
         "Write a picture even if nothing is seen, as of the empty frames of a sequence.", picture},
        {"preview", 0, "S", "",
         "Write what is there of the picture every S seconds while it is drawn: first coarse, then "
         "part by part from the middle. What was there before is replaced.",
         picture},
        {"cache-size", 0, "MB", "a quarter of the free memory, at most 2147",
         "Memory for what is read between the nodes of a grid.", picture},
        {"read-error", 0, "E", formatNumber(options.tolerance),
         "Error of what is read between the nodes, 1e-6 to 0.1: of the density, and of its "
         "gradient "
         "relative to a flat face's.",
         picture},
    };
    for (const OptionEntry& entry : cameraEntries()) entries.push_back(entry);
    const std::vector<OptionEntry> ofLight{
        {"shadows", 0, "", "", "Let objects stop the light of lamps.", light},
        {"gather", 0, "N", std::to_string(options.transport.gather),
         "Directions per line of sight in which a matt surface looks for light from around, which "
         "objects may stop (ambient occlusion); 0: nothing stops it.",
         light},
        {"gather-distance", 0, "D", "any", "World units beyond which nothing stops that light.",
         light},
        {"bounces", 0, "N", std::to_string(options.transport.bounces),
         "How often light goes on from one matt surface to the next, where it is gathered.", light},
        {"depth", 0, "N", std::to_string(options.transport.depth),
         "How often a line of sight is mirrored and refracted at most.", light},
        {"volume-method",
         0,
         "KIND",
         "steps",
         "steps: even steps through volumes, smooth. tracking: random ones, which are exact on "
         "average.",
         light,
         {.words = kVolumeMethods}},
        {"step", 0, "V", formatNumber(options.volumes.step), "Voxels to a step in volumes.", light},
    };
    entries.insert(entries.end(), ofLight.begin(), ofLight.end());
    return entries;
}

PictureOptions readPictureOptions(const OptionValues& values) {
    PictureOptions options;
    if (const auto size = values.size("res", 1, kMostPixels)) {
        options.width = size->x();
        options.height = size->y();
    }
    options.samples = values.wholeNumber("samples", 1, kMostSamples, options.samples);
    options.filter = static_cast<PixelFilter>(values.choice("filter", pixelFilterNames(), 0));
    if (const auto crop = values.wholeNumbers("crop", 4, ',')) {
        options.crop = CropWindow{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
    }
    options.background = values.vector("background", kAnyColor);
    options.seed = static_cast<std::uint32_t>(
        values.wholeNumber("seed", 0, std::numeric_limits<int>::max(), 0));
    options.allowEmpty = values.has("allow-empty");
    options.previewSeconds =
        values.number("preview", {.low = 0, .high = 1e6}, options.previewSeconds);
    options.cacheBytes =
        static_cast<std::size_t>(values.wholeNumber("cache-size", 1, kMostMegabytes, 0)) * 1000000;
    options.tolerance = values.number("read-error", {.low = 1e-6, .high = 0.1}, options.tolerance);
    options.camera = readCamera(values, double(options.height) / options.width);
    options.transport = readTransport(values);
    options.volumes.method =
        static_cast<VolumeOptions::Method>(values.choice("volume-method", kVolumeMethods, 0));
    options.volumes.step = values.number("step", {.low = 0.05, .high = 16}, options.volumes.step);
    return options;
}

ImageChannels readChannels(const OptionValues& values) {
    const std::vector<bool> chosen = values.choices("channels", channelNames());
    return {chosen[0], chosen[1], chosen[2], chosen[3]};
}

}  // namespace bandvox::app

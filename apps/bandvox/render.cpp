// bandvox render: densities in .vdb files to a picture, or to several.

#include "command_run.h"
#include "commands.h"
#include "frame_pattern.h"
#include "render_scene.h"
#include "render_settings.h"
#include "words.h"

#include <bandvox/render/density_to_image.h>
#include <bandvox/render/image.h>
#include <bandvox/render/scene_to_image.h>
#include <bandvox/render/shading.h>
#include <bandvox/render/turntable.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace bandvox::app {
namespace {

constexpr int kMostTurns = 100000;

struct RenderRequest {
    std::string output;  // may hold a pattern for the number of a frame
    SceneRequest scene;
    PictureOptions picture;
    ImageChannels channels;
    Shading shading = Shading::Spectral;
    bool previews = false;
    int turns = 0;            // pictures of a turntable
    std::vector<int> frames;  // empty of a single picture
};

// Older shadings are there to compare them with: they draw one matt surface under one lamp.
void requirePlain(const CommandLine& line, const RenderRequest& request) {
    const std::vector<ObjectRequest>& objects = request.scene.objects;
    const bool isPlain = objects.size() == 1 &&
                         objects[0].object.kind == SceneObject::Kind::Surface &&
                         request.scene.lights.size() == 1 && !request.scene.environment.map;
    if (!isPlain) line.fail("shading", "spectral for anything but one surface under one lamp");
}

bool hasFrames(const SceneRequest& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const ObjectRequest& object) { return hasFrame(object.file); });
}

void readFrames(const CommandLine& line, RenderRequest& request) {
    request.turns = line.wholeNumber("turntable", 1, kMostTurns, 0);
    const bool hasInputFrames = hasFrames(request.scene);
    if (const auto text = line.text("frames")) {
        const auto range = parseFrames(*text);
        if (!range) line.fail("frames", "frames as in 7, 1-100 or 1-100x2");
        request.frames = range->numbers();
    } else if (request.turns > 0) {
        request.frames = FrameRange{1, request.turns, 1}.numbers();
    }
    if (hasInputFrames && request.frames.empty()) {
        throw Error(ErrorKind::Usage,
                    "an input has a place for the number of a frame; expected "
                    "--frames to say which");
    }
    const bool isSequence = request.frames.size() > 1 || request.turns > 0;
    if (isSequence && !hasFrame(request.output)) {
        throw Error(ErrorKind::Usage, "option --output is '" + request.output +
                                          "'; expected a place for the number of a frame in it, "
                                          "as in name.####.png");
    }
    for (const int frame : request.frames) {
        const std::string picture = withFrame(request.output, frame);
        if (line.text("stats") == picture) {
            line.fail("stats",
                      "a file of its own: this is the picture of frame " + std::to_string(frame));
        }
    }
    if (request.turns > 0 &&
        (request.frames.front() < 1 || request.frames.back() > request.turns)) {
        line.fail("frames", "from 1 to no more than the " + std::to_string(request.turns) +
                                " pictures of the turntable");
    }
}

// What of a picture's settings the library refuses; empty if it takes them.
std::string refusalOf(const PictureOptions& picture) {
    try {
        requireValid(picture);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

// What is wrong with settings of a picture, of which a scene file gives some: then it names these,
// and options only beside them. A scene file that is wrong by itself is no wrong use of the
// command.
Error settingsError(const SceneRequest& scene, const std::vector<std::string>& settings,
                    const std::string& message) {
    std::vector<std::string> named, asked;
    for (const std::string& setting : settings) {
        const auto place = scene.places.find(setting);
        if (place != scene.places.end()) {
            named.push_back(place->second);
        } else {
            asked.push_back("--" + setting);
        }
    }
    if (named.empty()) return {ErrorKind::Usage, message};
    const ErrorKind kind = asked.empty() ? ErrorKind::Input : ErrorKind::Usage;
    named.insert(named.end(), asked.begin(), asked.end());
    return {kind, "'" + scene.file + "': " + joined(named, ", ") + ": " + message};
}

// Refuses settings of which each is one that a picture may have, but not all together. A setting
// takes part in that if without it the picture would not be refused so.
void requireValidTogether(const SceneRequest& scene, const PictureOptions& picture) {
    const std::string refusal = refusalOf(picture);
    if (refusal.empty()) return;
    std::vector<std::string> settings;
    for (const auto& [name, value] : scene.picture.all()) {
        OptionValues others;
        for (const auto& [other, text] : scene.picture.all()) {
            if (other != name) others.set(other, text, scene.picture.origin(other));
        }
        try {
            if (refusalOf(readPictureOptions(others)) != refusal) settings.push_back(name);
        } catch (const Error&) {
            continue;  // what is left cannot even be read
        }
    }
    throw settingsError(scene, settings, refusal);
}

RenderRequest parseRender(const CommandLine& line) {
    RenderRequest request;
    request.output = line.requiredText("output");
    requireExtension(request.output, {".png", ".exr"});
    std::vector<std::string> names;
    for (const OptionEntry& entry : pictureEntries()) names.push_back(entry.name);
    request.scene = readScene(line, names);
    request.picture = readPictureOptions(request.scene.picture);
    requireUsedCamera(request.scene.picture, request.picture.camera);
    request.channels = readChannels(request.scene.picture);
    if (request.scene.picture.has("channels") && extensionOf(request.output) != ".exr") {
        const Error error = settingsError(request.scene, {"channels"},
                                          "channels are chosen of an .exr, and '" + request.output +
                                              "' is none: a .png holds colour alone");
        throw Error(ErrorKind::Usage, error.what());
    }
    request.previews = request.scene.picture.has("preview");
    request.shading = static_cast<Shading>(line.choice("shading", 0));
    if (request.shading != Shading::Spectral) requirePlain(line, request);
    requireValidTogether(request.scene, request.picture);
    for (const Light& light : request.scene.lights) requireValid(light);
    readFrames(line, request);
    return request;
}

RenderResult draw(const RenderRequest& request, const Scene& scene, const PictureOptions& picture,
                  Progress& progress) {
    if (request.shading == Shading::Spectral) return sceneToImage(scene, picture, progress);
    const SceneObject& object = scene.objects[0];
    RenderOptions options;
    static_cast<PictureOptions&>(options) = picture;
    options.shading = request.shading;
    options.iso = object.iso;
    options.color = object.material.color;
    options.light = scene.lights[0].place;
    options.ambient = scene.environment.color[0];
    try {
        return densityToImage(object.grid, options, progress);
    } catch (const Error& error) {
        const bool isOfObject =
            error.kind() == ErrorKind::Input || error.kind() == ErrorKind::Result;
        if (!isOfObject) throw;
        throw Error(error.kind(), object.name + ": " + error.what());
    }
}

// Calls `body` for what is drawn of a scene. What its objects do not allow is no wrong use of the
// command if a scene file wants it so.
template <typename Body>
auto ofScene(const SceneRequest& scene, const Body& body) {
    try {
        return body();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Usage || scene.file.empty()) throw;
        const std::string message = error.what(), file = "'" + scene.file + "': ";
        if (message.starts_with(file)) throw Error(ErrorKind::Input, message);
        // Only the objects say where a camera looks to if nothing else does.
        std::vector<std::string> settings;
        for (const char* setting : {"eye", "lookat", "up", "from"}) {
            if (scene.picture.has(setting)) settings.emplace_back(setting);
        }
        throw settingsError(scene, settings, message);
    }
}

// What all pictures together took.
struct Totals {
    std::int64_t rays = 0, hits = 0;
};

// A picture of other colours than those that were asked for is told of before it is drawn.
void warnOfColors(CommandRun& run, const std::string& output) {
    if (extensionOf(output) != ".png") return;
    if (const std::string fault = colorConfigurationFault(); !fault.empty()) {
        run.warn({fault}, ErrorKind::Runtime);
    }
}

Image drawFrame(CommandRun& run, const RenderRequest& request, const Scene& scene,
                const PictureOptions& picture, const AtomicFile& output, Totals& totals) {
    PictureOptions options = picture;
    if (request.previews) {
        if (output.inPlace()) {
            throw Error(ErrorKind::Usage, "--preview replaces the picture again and again, and '" +
                                              output.target().string() +
                                              "' is no file that can be replaced");
        }
        options.preview = [&](const Image& image) {
            // Nothing is written of a picture in which nothing is seen.
            const bool isSeen = std::any_of(image.depth.begin(), image.depth.end(),
                                            [](float depth) { return std::isfinite(depth); });
            if (!isSeen) return;
            AtomicFile file(output.target());
            writeImage(file, image, request.channels, run.progress());
            file.commit();
        };
    }
    const double start = run.seconds();
    RenderResult result =
        ofScene(request.scene, [&] { return draw(request, scene, options, run.progress()); });
    result.image.metadata.emplace_back("bandvox_seconds", run.seconds() - start);
    run.say("drawn    " + std::to_string(result.image.width) + " x " +
            std::to_string(result.image.height) + " pixels, " +
            formatCount(result.rays, "line of sight", "lines of sight") + ", " +
            formatCount(result.hits, "hit", "hits"));
    totals.rays += result.rays;
    totals.hits += result.hits;
    run.count("rays", totals.rays);
    run.count("hits", totals.hits);
    return std::move(result.image);
}

void drawSequence(CommandRun& run, const RenderRequest& request) {
    Totals totals;
    std::optional<Scene> scene;
    std::vector<CameraOptions> cameras;
    const bool hasInputFrames = hasFrames(request.scene);
    const auto drawOne = [&](int frame) {
        if (!scene || hasInputFrames) {
            scene = loadScene(run, request.scene, frame);
            if (request.turns > 0) {
                cameras = ofScene(request.scene, [&] {
                    return turntable(*scene, request.picture, request.turns);
                });
            }
        }
        PictureOptions picture = request.picture;
        if (request.turns > 0) picture.camera = cameras.at(static_cast<std::size_t>(frame - 1));
        AtomicFile output(withFrame(request.output, frame));
        const Image image = drawFrame(run, request, *scene, picture, output, totals);
        run.writePart(output, [&](AtomicFile& file) {
            writeImage(file, image, request.channels, run.progress());
        });
    };
    for (std::size_t i = 0; i < request.frames.size(); ++i) {
        const int frame = request.frames[i];
        run.beginPart(i, request.frames.size());
        try {
            drawOne(frame);
        } catch (const Error& error) {
            // Wrong options are no frame's fault, nor is the user who stops the command.
            const bool isOfFrame =
                error.kind() != ErrorKind::Usage && error.kind() != ErrorKind::Interrupted;
            if (!isOfFrame) throw;
            throw Error(error.kind(), "frame " + std::to_string(frame) + ": " + error.what());
        }
    }
    run.count("frames", request.frames.size());
    run.finish();
}

}  // namespace

const CommandTable& renderTable() {
    static const CommandTable table = [] {
        std::vector<OptionEntry> options{{"output",
                                          'o',
                                          "FILE",
                                          "",
                                          "The .png or .exr file to write. Needed.",
                                          "Picture",
                                          {.endings = {".png", ".exr"}}}};
        for (const auto& entries : {pictureEntries(), sceneEntries()}) {
            options.insert(options.end(), entries.begin(), entries.end());
        }
        const std::string several = "Several pictures";
        options.push_back({"turntable", 0, "N", "",
                           "Go around the objects in N pictures. The output's name has a place for "
                           "their numbers, #### or %04d.",
                           several});
        options.push_back({"frames", 0, "A-BxS", "all of a turntable",
                           "Which pictures: 7, 1-100, 1-100x2. Inputs may have a place for the "
                           "number, too.",
                           several});
        options.push_back({"shading",
                           0,
                           "KIND",
                           shadingNames().front(),
                           joined(shadingNames(), ", ") +
                               ": where normals come from. All but the first see voxels as cubes, "
                               "show stripes, and are here for comparison.",
                           "For comparison",
                           {.words = shadingNames()}});
        return CommandTable{
            "render",
            "Draw densities (.vdb) as a picture (.png, .exr).",
            "Draws the surface where the density is 0.5, or as given, or the fog that it is. Lines "
            "of sight are followed to the band-limited density that the grid stands for, and the "
            "normal is its gradient, so the picture shows no voxels. Densities and level sets of "
            "other programs are read by the cubic spline through their values. An .exr also holds "
            "depth (Z), normals (N) and positions (P). A scene file is JSON: lists of objects and "
            "lights, and groups environment, camera and picture, whose settings have the names of "
            "the options below.",
            {{"INPUT",
              "A .vdb file, as often as there are objects, or one .json file with a scene; "
              "stdin.vdb is the standard input.",
              true,
              {.endings = {".vdb", ".json"}}}},
            options,
            {
                {"bandvox render bunny.vdb -o bunny.png",
                 "The whole object, on a transparent ground."},
                {"bandvox render bunny.vdb -o bunny.exr --res 1920x1080 --samples 4",
                 "With depth, normals and positions, four lines of sight per pixel."},
                {"bandvox render bunny.vdb -o front.png --camera orthographic --from 0,0,1",
                 "A parallel view along -z."},
                {"bandvox render bunny.vdb ball.vdb -o two.png --transparency 0/1 --shadows",
                 "Two objects, the second of glass, with shadows."},
                {"bandvox render cloud.vdb -o cloud.png --mode volume --anisotropy 0.6",
                 "A density as a cloud."},
                {"bandvox render bunny.vdb -o bunny.####.png --turntable 36", "Once around it."},
            }};
    }();
    return table;
}

void runRender(const CommandLine& line) {
    const RenderRequest request = parseRender(line);
    CommandRun run(line);
    warnOfColors(run, request.output);
    if (!request.frames.empty()) return drawSequence(run, request);
    AtomicFile output(request.output);
    const Scene scene = loadScene(run, request.scene, 0);
    for (const SceneObject& object : scene.objects) run.leaveToExit(object.grid);
    Totals totals;
    const Image image = drawFrame(run, request, scene, request.picture, output, totals);
    run.writeOutput(output, [&](AtomicFile& file) {
        writeImage(file, image, request.channels, run.progress());
    });
}

}  // namespace bandvox::app

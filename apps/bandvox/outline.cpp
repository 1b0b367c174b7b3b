// bandvox outline: free-form surfaces, volumes and meshes as a drawing of lines.

#include "command_run.h"
#include "commands.h"
#include "file_endings.h"
#include "outline_input.h"
#include "render_settings.h"
#include "report_words.h"
#include "words.h"

#include <bandvox/outline/patches_to_outline.h>
#include <bandvox/outline/volumes_to_outline.h>
#include <bandvox/outline/write_outline.h>
#include <bandvox/source/read_patches.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bandvox::app {
namespace {

const std::vector<std::string> kOutlineKinds{"contour",      "boundary", "crease",
                                             "intersection", "isophote", "suggestive"};

const std::vector<std::string> kFillKinds{"none", "flat", "toon"};

std::vector<std::string> outlineEndings() {
    std::vector<std::string> endings = vdbAndMeshEndings();
    endings.emplace_back(".bpt");
    endings.insert(endings.end(), cadExtensions().begin(), cadExtensions().end());
    return endings;
}

}  // namespace

const CommandTable& outlineTable() {
    static const CommandTable table = [] {
        const OutlineOptions options;
        const StrokeOptions stroke;
        const std::string page = "Page", lines = "Lines";
        CommandTable made{
            "outline",
            "Draw free-form surfaces, volumes and meshes as lines (.svg, .pdf, .eps, .dxf).",
            "Draws the contours, boundaries, creases and intersections of Bézier and B-spline "
            "surfaces as Bézier curves, and the contours of volumes and of meshes, which are made "
            "volumes first. They are computed on the surfaces, never on polygons, and "
            "what is hidden is found by lines of sight to the surfaces. Visible and hidden lines "
            "are layers of the drawing.",
            {{"INPUT",
              "Newell's .bpt, or .obj with free-form surfaces (cstype bezier or bspline); parts as "
              ".step, .stp, .iges, .igs or .brep, where Open CASCADE was built in; a .vdb; a mesh "
              "or a built-in shape; several of them are one scene.",
              true,
              {.words = shapeWords(), .endings = outlineEndings()}}},
            {
                {"output",
                 'o',
                 "FILE",
                 "",
                 "The .svg, .pdf, .eps or .dxf file to write. Needed.",
                 page,
                 {.endings = outlineExtensions()}},
                {"page", 0, "SIZE",
                 formatNumber(options.width) + "x" + formatNumber(options.height),
                 "WxH in millimetres, or A3, A4, A5, letter, upright, or with -landscape.", page},
                {"margin", 0, "MM",
                 "a twentieth of the shorter side, at most " + formatNumber(options.margin),
                 "What stays free around the drawing.", page},
                {"tolerance", 0, "MM", formatNumber(options.tolerance),
                 "How far lines may be from the true ones.", lines},
                {"crease-angle", 0, "DEG", formatNumber(options.creaseAngle),
                 "Patches that meet at more than this are drawn with a line between, 0 to 180.",
                 lines},
                {"kinds",
                 0,
                 "LIST",
                 joined(kOutlineKinds, ","),
                 "Which to draw.",
                 lines,
                 {.words = kOutlineKinds, .isList = true}},
                {"isophotes", 0, "C,...", "none",
                 "Also lines where the cosine of the angle between normal and light is C, as in "
                 "0.3,0.7.",
                 lines},
                {"suggestive", 0, "STRENGTH", "none",
                 "Of volumes and meshes: also suggestive contours, the more the lower, as in 20.",
                 lines},
                {"fill",
                 0,
                 "KIND",
                 "none",
                 "What is between visible lines: none; flat, a colour for each object; toon, "
                 "tones of it by the angle between surface and light.",
                 lines,
                 {.words = kFillKinds}},
                {"tones", 0, "C,...", "0.25,0.7",
                 "Cosines of that angle at which the tones of a toon fill change, ascending.",
                 lines},
                {"fill-colors", 0, "COLOR,...", joined(stroke.fillColors, ","),
                 "Colours of the objects, one after the other, #rgb or #rrggbb.", lines},
                {"shade", 0, "X", formatNumber(stroke.shade),
                 "The darkest tone, as a part of the colour.", lines},
                {"light", 0, "X,Y,Z", "-0.4,0.7,0.8",
                 "Direction to that light, along the camera's right, up and back.", lines},
                {"no-hidden", 0, "", "", "Leave hidden lines away.", lines},
                {"stroke", 0, "MM", formatNumber(stroke.width), "Width of visible lines.", lines},
                {"stroke-color", 0, "COLOR", stroke.color,
                 "Their colour, #rgb or #rrggbb; in an .svg also a word of CSS.", lines},
                {"hidden-stroke", 0, "MM", formatNumber(stroke.hiddenWidth),
                 "Width of hidden lines.", lines},
                {"hidden-color", 0, "COLOR", stroke.hiddenColor, "Their colour.", lines},
                {"dash", 0, "LENGTHS", stroke.dash,
                 "Lengths of dashes and gaps of hidden lines, mm.", lines},
            },
            {
                {"bandvox outline teapot.bpt -o teapot.svg --up 0,0,1 --from 1,-2,1",
                 "Newell's teapot, hidden lines dashed."},
                {"bandvox outline bunny.obj -o bunny.svg --resolution 96",
                 "A mesh; the fewer voxels, the plainer the drawing."},
                {"bandvox outline hull.obj -o hull.svg --page A4-landscape --camera orthographic",
                 "A parallel view on a page for a printer."},
            }};
        for (const auto& entries : {outlineInputEntries(), cameraEntries()}) {
            made.options.insert(made.options.end(), entries.begin(), entries.end());
        }
        return made;
    }();
    return table;
}

namespace {

constexpr Range kSomeLength{.low = 0, .high = 1e5, .lowOpen = true};

struct OutlineRequest {
    OutlineInputs inputs;
    std::string output;
    OutlineOptions options;
    StrokeOptions stroke;
    std::vector<bool> kinds;
};

void readPage(const CommandLine& line, OutlineOptions& options) {
    const auto text = line.text("page");
    if (!text) return;
    const std::map<std::string, std::array<double, 2>> sizes{
        {"a3", {297, 420}}, {"a4", {210, 297}}, {"a5", {148, 210}}, {"letter", {215.9, 279.4}}};
    std::string name = lowerCase(*text);
    const std::string turned = "-landscape";
    const bool isTurned = name.ends_with(turned);
    if (isTurned) name.resize(name.size() - turned.size());
    std::array<double, 2> size{};
    if (const auto found = sizes.find(name); found != sizes.end()) {
        size = found->second;
        if (isTurned) std::swap(size[0], size[1]);
    } else {
        const char* const end = name.data() + name.size();
        const auto width = std::from_chars(name.data(), end, size[0]);
        bool isSize = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x' && !isTurned;
        if (isSize) {
            const auto height = std::from_chars(width.ptr + 1, end, size[1]);
            isSize = height.ec == std::errc() && height.ptr == end;
        }
        constexpr Range kSide{.low = 1, .high = 1e5};
        if (!isSize || !kSide.contains(size[0]) || !kSide.contains(size[1])) {
            line.fail("page",
                      "WxH in mm, each 1 or more, A3, A4, A5 or letter, the last four also with "
                      "-landscape");
        }
    }
    options.width = size[0];
    options.height = size[1];
}

// Colours and lengths go into a style sheet, and must not end it.
std::string readStyle(const CommandLine& line, const std::string& option, std::string fallback) {
    const auto text = line.text(option);
    if (!text) return fallback;
    const bool isPlain = !text->empty() && std::all_of(text->begin(), text->end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string("#(),.% -").find(c) != std::string::npos;
    });
    if (!isPlain) line.fail(option, "a value as in CSS: letters, digits and #(),.%-");
    return *text;
}

std::vector<double> readCosines(const CommandLine& line, const std::string& option,
                                const std::vector<double>& fallback) {
    constexpr std::size_t kMost = 64;
    return line
        .numbers(option, 1, kMost, "cosines between -1 and 1, as in 0.3,0.7",
                 {.low = -1, .high = 1, .lowOpen = true, .highOpen = true})
        .value_or(fallback);
}

// An option that changes nothing is taken for a mistake. `use`: what it is for, and what is
// expected.
void requireUsed(const CommandLine& line, const char* option, bool isUsed, const char* use) {
    if (!line.isAsked(option) || isUsed) return;
    throw Error(ErrorKind::Usage, std::string("--") + option + " is for " + use);
}

void readFill(const CommandLine& line, OutlineRequest& request) {
    OutlineOptions& options = request.options;
    options.fill = static_cast<OutlineFillKind>(line.choice("fill", 0));
    const bool isToon = options.fill == OutlineFillKind::Toon;
    requireUsed(line, "tones", isToon, "--fill toon; expected that, too");
    requireUsed(line, "shade", isToon, "--fill toon; expected that, too");
    requireUsed(line, "fill-colors", options.fill != OutlineFillKind::None,
                "--fill flat or toon; expected that, too");
    options.tones = readCosines(line, "tones", options.tones);
    const auto& tones = options.tones;
    if (std::adjacent_find(tones.begin(), tones.end(), std::greater_equal<>()) != tones.end()) {
        line.fail("tones", "ascending cosines between -1 and 1, as in 0.25,0.7");
    }
    request.stroke.shade = line.number("shade", {.low = 0, .high = 1}, request.stroke.shade);
    if (const auto colors = line.text("fill-colors")) {
        request.stroke.fillColors.clear();
        for (const std::string_view color : split(*colors, ',')) {
            request.stroke.fillColors.emplace_back(color);
        }
    }
}

void readKinds(const CommandLine& line, OutlineRequest& request) {
    request.kinds = line.choices("kinds", kOutlineKinds);
    const auto isKept = [&](OutlineKind kind) {
        return request.kinds[static_cast<std::size_t>(kind)];
    };
    requireUsed(line, "isophotes", isKept(OutlineKind::Isophote),
                "isophotes, which --kinds leaves out; expected isophote among them");
    requireUsed(line, "suggestive", isKept(OutlineKind::Suggestive),
                "suggestive contours, which --kinds leaves out; expected suggestive among them");
    requireUsed(line, "crease-angle", isKept(OutlineKind::Crease),
                "creases, which --kinds leaves out; expected crease among them");
    const OutlineOptions& options = request.options;
    requireUsed(line, "light", options.fill == OutlineFillKind::Toon || !options.isophotes.empty(),
                "--isophotes and --fill toon; expected one of them, too");
}

void readStrokes(const CommandLine& line, OutlineRequest& request) {
    request.options.hidden = !line.has("no-hidden");
    for (const char* const option : {"hidden-stroke", "hidden-color", "dash"}) {
        requireUsed(line, option, request.options.hidden,
                    "hidden lines, which --no-hidden leaves away; expected one of the two");
    }
    StrokeOptions& stroke = request.stroke;
    stroke.width = line.number("stroke", kSomeLength, stroke.width);
    stroke.hiddenWidth = line.number("hidden-stroke", kSomeLength, stroke.hiddenWidth);
    stroke.color = readStyle(line, "stroke-color", stroke.color);
    stroke.hiddenColor = readStyle(line, "hidden-color", stroke.hiddenColor);
    stroke.dash = readStyle(line, "dash", stroke.dash);
    requireValid(stroke);
}

// What a format cannot hold is said before anything is drawn.
void requireWritable(const CommandLine& line, const OutlineRequest& request) {
    const std::string extension = extensionOf(request.output);
    if (extension == ".dxf" && request.options.fill != OutlineFillKind::None) {
        line.fail("fill", "none for a .dxf, which has lines only");
    }
    if (extension != ".svg") requireHexColors(request.stroke);
}

OutlineRequest parseOutline(const CommandLine& line) {
    OutlineRequest request;
    request.inputs = readOutlineInputs(line);
    request.output = line.requiredText("output");
    requireExtension(request.output, outlineExtensions());
    OutlineOptions& options = request.options;
    readPage(line, options);
    const double shorter = std::min(options.width, options.height);
    options.margin = line.number("margin", {.low = 0, .high = 0.5 * shorter, .highOpen = true},
                                 std::min(options.margin, 0.05 * shorter));
    options.tolerance = line.number("tolerance", kSomeLength, options.tolerance);
    options.creaseAngle = line.number("crease-angle", {.low = 0, .high = 180}, options.creaseAngle);
    options.camera = readCamera(
        line, (options.height - 2 * options.margin) / (options.width - 2 * options.margin));
    requireUsedCamera(line, options.camera);
    options.isophotes = readCosines(line, "isophotes", {});
    if (line.has("suggestive")) {
        options.suggestive = line.number("suggestive", {.low = 0, .high = 1e9}, 0);
    }
    readFill(line, request);
    options.light = line.vector("light", kAnyPlace).value_or(options.light);
    if (!(options.light.length() > 0)) line.fail("light", "a direction, X,Y,Z, not all 0");
    readKinds(line, request);
    readStrokes(line, request);
    requireWritable(line, request);
    return request;
}

void sayOutline(CommandRun& run, const Outline& outline) {
    std::int64_t anchors = 0, visible = 0, visibleAnchors = 0;
    for (const OutlinePath& path : outline.paths) {
        anchors += static_cast<std::int64_t>(path.anchors());
        if (path.hidden > 0) continue;
        ++visible;
        visibleAnchors += static_cast<std::int64_t>(path.anchors());
    }
    const auto paths = static_cast<std::int64_t>(outline.paths.size());
    run.say("drawn    " + formatCount(paths, "path", "paths") + " with " +
            formatCount(anchors, "anchor", "anchors") + ", " +
            formatCount(visible, "path", "paths") + " with " +
            formatCount(visibleAnchors, "anchor", "anchors") + " of them seen");
    if (!outline.fills.empty()) {
        const auto regions = static_cast<std::int64_t>(outline.fills.size());
        run.say("filled   " + formatCount(regions, "region", "regions"));
        run.count("regions", regions);
    }
    run.count("paths", paths);
    run.count("anchors", anchors);
    run.count("visible_paths", visible);
    run.count("visible_anchors", visibleAnchors);
}

}  // namespace

void runOutline(const CommandLine& line) {
    const OutlineRequest request = parseOutline(line);
    CommandRun run(line);
    AtomicFile output(request.output);
    const OutlineScene scene = loadOutlineScene(run, request.inputs);
    Outline outline;
    {
        const ProgressStage stage(run.progress(), "drawing", 0);
        outline =
            scene.volumes.empty()
                ? patchesToOutline(scene.patches, request.options, run.progress())
                : volumesToOutline(scene.volumes, scene.patches, request.options, run.progress());
    }
    std::erase_if(outline.paths, [&](const OutlinePath& path) {
        return !request.kinds[static_cast<std::size_t>(path.kind)];
    });
    if (outline.paths.empty() && outline.fills.empty()) {
        throw Error(ErrorKind::Result,
                    "the drawing is empty: it has no lines of these --kinds; expected some");
    }
    sayOutline(run, outline);
    run.writeOutput(output, [&](AtomicFile& file) { writeOutline(file, outline, request.stroke); });
}

}  // namespace bandvox::app

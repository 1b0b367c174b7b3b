// bandvox fit: values at scattered places as a smooth surface.

#include "command_run.h"
#include "commands.h"
#include "density_report.h"
#include "fit_output.h"
#include "fit_report.h"
#include "fit_volume.h"
#include "mesh_output.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/scatter/fit_surface.h>
#include <bandvox/scatter/read_scattered_points.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::app {

const CommandTable& fitTable() {
    static const CommandTable table = [] {
        CommandTable made{
            "fit",
            "Fit a smooth surface to values at scattered places.",
            "Reads a table of places and values, x y and a value or several in each line, and "
            "makes of them the smoothest sum of B-spline surfaces that has these values. It is "
            "twice "
            "continuously differentiable, and written as Bézier patches, samples, a mesh, a "
            "picture, or the solid under it. With --volume the places are in space, and the "
            "values become grids.",
            {{"POINTS",
              "A table: .csv .xyz .txt, .npy with a row for each point, or the points of a .ply.",
              false,
              {.endings = {".csv", ".xyz", ".txt", ".npy", ".ply"}}}},
            {
                {"columns", 0, "X,Y,VALUE,...", "x, y and all others",
                 "The columns to take, by name or number from 1; with --volume z comes after y.",
                 "Points"},
                {"rectangle", 0, "X0,Y0,X1,Y1", "of the points",
                 "What the surface covers; all points have to be in it.", "Points"},
                {"tolerance", 0, "T", "1e-12",
                 "How far the surface may be off at a point, in parts of the values' range, 0 to "
                 "1. More gives a coarser net. If it is given and not reached, or the surface is "
                 "off by more than 0.01 and --max-level was not given, the status is 4.",
                 "Surface"},
                {"smooth", 0, "NOISE", "",
                 "The values have errors of this standard deviation: the smoothest surface that "
                 "differs from them by so much.",
                 "Surface"},
                {"max-level", 0, "K", "from the data",
                 "At most 2^K cells along the longer side, 1 to 13; 1 to 16 with --volume.",
                 "Surface"},
                {"levels", 0, "A..B", "all",
                 "Sum up levels A to B only, as counted from 1: 1..3 leaves detail away.",
                 "Surface"},
                {"tension", 0, "T", "the most likely, or 2",
                 "The surface is stiff within 1/T, and like a membrane farther off, in units of "
                 "the root of the rectangle's area, or of the longest side of a volume's box; 0.01 "
                 "to "
                 "10000.",
                 "Surface"},
            },
            {
                {"bandvox fit points.csv -o surface.bpt", "Bicubic Bézier patches."},
                {"bandvox fit points.csv -o surface.npy --samples 1001", "An array of samples."},
                {"bandvox fit terrain.csv -o terrain.vdb -r 500 --smooth 0.2",
                 "The solid under a terrain, whose heights were measured to 0.2."},
                {"bandvox fit cloud.csv --volume -o field.vdb -r 200",
                 "Values at places in space."},
            }};
        for (const OptionEntry& entry : fitVolumeEntries()) made.options.push_back(entry);
        for (const OptionEntry& entry : fitOutputEntries()) made.options.push_back(entry);
        return made;
    }();
    return table;
}

namespace {

struct FitRequest {
    std::string input;
    PointColumnChoice columns;
    FitSurfaceOptions fit;
    bool hasTolerance = false;
    std::optional<std::array<int, 2>> levels;  // from 1
    FitOutput output;
};

std::vector<std::string> wordsIn(const std::string& text) {
    std::vector<std::string> words;
    for (const std::string_view word : split(text, ',')) words.emplace_back(word);
    return words;
}

std::optional<Rectangle> readRectangle(const CommandLine& line) {
    const std::string expected = "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1";
    const auto n = line.numbers("rectangle", 4, 4, expected);
    if (!n) return std::nullopt;
    const Rectangle rectangle{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
    if (!(rectangle.x0 < rectangle.x1 && rectangle.y0 < rectangle.y1)) {
        line.fail("rectangle", expected);
    }
    return rectangle;
}

std::array<int, 2> readLevels(const CommandLine& line, const std::string& text) {
    std::array<int, 2> levels{};
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, levels[0]);
    bool isRange = first.ec == std::errc() && text.compare(first.ptr - text.data(), 2, "..") == 0;
    if (isRange) {
        const auto last = std::from_chars(first.ptr + 2, end, levels[1]);
        isRange = last.ec == std::errc() && last.ptr == end;
    }
    if (!isRange || levels[0] < 1 || levels[1] < levels[0]) {
        line.fail("levels", "A..B with 1 <= A <= B");
    }
    return levels;
}

FitRequest parseFit(const CommandLine& line) {
    FitRequest request;
    request.input = line.positional(0);
    if (const auto text = line.text("columns")) request.columns.columns = wordsIn(*text);
    FitSurfaceOptions& fit = request.fit;
    fit.rectangle = readRectangle(line);
    request.hasTolerance = line.has("tolerance");
    fit.tolerance = line.number("tolerance", {.low = 0, .high = 1}, fit.tolerance);
    if (line.has("smooth")) fit.noise = line.number("smooth", {.low = 0, .lowOpen = true}, 1);
    if (fit.noise > 0) refuseOptions(line, {"tolerance"}, "with --smooth");
    if (line.has("max-level")) fit.maxLevel = line.wholeNumber("max-level", 1, 13, 1);
    if (line.has("tension")) fit.tension = line.number("tension", {.low = 0.01, .high = 1e4}, 1);
    if (const auto text = line.text("levels")) request.levels = readLevels(line, *text);
    request.output = readFitOutput(line);
    return request;
}

void sayFit(CommandRun& run, const SurfaceFit& fit) {
    const FitLevel& last = fit.report.back();
    run.say(
        "fitted   " + formatCount(static_cast<std::int64_t>(fit.levels.size()), "level", "levels") +
        ", the finest of " + std::to_string(last.cells[0]) + " x " + std::to_string(last.cells[1]) +
        " cells; at the points off by " + formatNumber(last.largest, 2) +
        " of the range at most, tension " + formatNumber(fit.tension, 3));
    nlohmann::json levels = nlohmann::json::array();
    for (const FitLevel& level : fit.report) {
        run.sayMore("         level " + std::to_string(level.level) + ": " +
                    std::to_string(level.cells[0]) + " x " + std::to_string(level.cells[1]) +
                    " cells, off by " + formatNumber(level.largest, 2) + " at most, " +
                    formatNumber(level.rms, 2) + " in the root of the mean square");
        levels.push_back({{"level", level.level},
                          {"cells", level.cells},
                          {"largest", level.largest},
                          {"rms", level.rms}});
    }
    run.count("tension", fit.tension);
    run.count("levels", levels);
    sayDuplicates(run, fit.points, fit.duplicates);
}

// What the surface does between the points is not what they say if they are noisy or far apart.
void judgeShape(CommandRun& run, const FitRequest& request, const SurfaceFit& fit) {
    constexpr double kFar = 0.5;
    if (fit.swing > kFar) {
        run.say("         it goes beyond the values by " + formatNumber(fit.swing, 2) +
                " of their range: noisy values need --smooth, and points far apart a --tension "
                "of more than " +
                formatNumber(fit.tension, 3));
    }
    constexpr double kNearly = 0.1;
    if (request.fit.noise > 0 && !(std::abs(fit.noiseLeft - 1) <= kNearly)) {
        std::string message = "the surface differs from the values by " +
                              formatNumber(fit.noiseLeft * request.fit.noise, 3);
        message += " in the root of the mean square; expected " +
                   formatNumber(request.fit.noise, 3) + ", by --smooth";
        run.warn({message}, ErrorKind::Result);
    }
}

BsplineSurface chosenSum(const FitRequest& request, SurfaceFit& fit) {
    if (!request.levels) return fit.sum();
    const auto count = static_cast<int>(fit.levels.size());
    const auto [first, last] = *request.levels;
    if (last > count) {
        throw Error(ErrorKind::Usage, "option --levels is " + std::to_string(first) + ".." +
                                          std::to_string(last) + ", and the surface has " +
                                          formatCount(count, "level", "levels") +
                                          "; expected some of them");
    }
    return fit.sum(static_cast<std::size_t>(first) - 1, static_cast<std::size_t>(last) - 1);
}

// A patch takes some 800 bytes of text.
void requirePatches(const FitRequest& request, const BsplineSurface& surface) {
    constexpr std::int64_t kMostUnasked = 1'000'000;
    const std::int64_t patches = std::int64_t{surface.cells()[0]} * surface.cells()[1];
    if (request.output.kind != FitOutput::Kind::Patches || request.fit.maxLevel ||
        patches <= kMostUnasked) {
        return;
    }
    throw Error(ErrorKind::Usage,
                "the surface has " + std::to_string(patches) + " patches, some " +
                    formatBytes(patches * 800) + " of a .bpt file; expected " +
                    std::to_string(kMostUnasked) +
                    " at most, unless --max-level is given, or --levels leaves detail away");
}

}  // namespace

void runFit(const CommandLine& line) {
    if (line.has("volume")) return runFitVolume(line);
    refuseOptions(line, {"reach"}, "without --volume");
    const FitRequest request = parseFit(line);
    CommandRun run(line);
    AtomicFile output(request.output.path);
    const ScatteredPoints points =
        readScatteredPoints(request.input, request.columns, run.progress());
    sayPoints(run, request.input, points);
    SurfaceFit fit;
    {
        const ProgressStage stage(run.progress(), "fitting", 0);
        fit = fitSurface(points, request.fit, run.progress());
    }
    sayFit(run, fit);
    if (request.fit.noise <= 0) {
        judgeResidual(run, {"surface", fit.report.back().largest, request.fit.tolerance,
                            request.hasTolerance, request.fit.maxLevel.has_value()});
    }
    judgeShape(run, request, fit);
    const BsplineSurface surface = chosenSum(request, fit);
    fit.levels.clear();
    requirePatches(request, surface);
    writeFit(run, output, request.output, {surface, points.names, request.input});
}

}  // namespace bandvox::app

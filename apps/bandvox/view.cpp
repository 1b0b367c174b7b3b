// bandvox view: a grid of a .vdb file to an HTML page that shows it.

#include "choose_grid.h"
#include "command_run.h"
#include "commands.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "view_page.h"
#include "words.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>

namespace bandvox::app {
namespace {

struct ViewRequest {
    std::string input;
    std::string output;
    std::optional<std::string> grid, title;
    std::optional<double> iso;
    int size = kViewSize;
};

ViewRequest parseView(const CommandLine& line) {
    ViewRequest request;
    request.input = line.positional(0);
    request.output = line.requiredText("output");
    requireExtension(request.output, {".html"});
    requireVdb("show", request.input);
    request.grid = line.text("grid");
    request.title = line.text("title");
    if (line.has("iso")) request.iso = line.number("iso", {}, 0);
    request.size = line.wholeNumber("size", kLeastViewSize, kMostViewSize, kViewSize);
    return request;
}

ViewPage summarize(CommandRun& run, const ViewRequest& request) {
    ViewPage page;
    // Whoever gets the page need not know the folder.
    page.file = std::filesystem::path(request.input).filename().string();
    {
        const ProgressStage stage(run.progress(), "read", 0);
        page.grid =
            chooseFloatGrid(readGrids(request.input), request.grid, "density", request.input);
    }
    page.title = request.title.value_or(page.file);
    summarizeGrid(page, request.iso, request.size, run.progress());

    const VolumeTexture& texture = page.texture;
    const double coarsest = std::max({texture.spacing[0], texture.spacing[1], texture.spacing[2]});
    run.say("reduced  '" + page.grid->getName() + "' to " + std::to_string(texture.size[0]) +
            " x " + std::to_string(texture.size[1]) + " x " + std::to_string(texture.size[2]) +
            " samples, " +
            (coarsest == 1 ? "its voxels" : formatNumber(coarsest, 3) + " voxels from each other") +
            ", to be seen at " + formatNumber(page.iso));
    run.count("samples", texture.values.size());
    run.count("spectrum_blocks", page.spectrum.blocks);
    return page;
}

void writePage(AtomicFile& file, const std::string& html) {
    std::ofstream out = file.open();
    out.write(html.data(), static_cast<std::streamsize>(html.size()));
    out.close();
    if (!out) {
        throw Error(ErrorKind::Runtime, "cannot write the page to '" + file.target().string() +
                                            "': " + std::strerror(errno));
    }
}

}  // namespace

const CommandTable& viewTable() {
    static const CommandTable table{
        "view",
        "Make a page (.html) that shows a volume (.vdb), to look at in a browser.",
        "Writes one HTML file that needs nothing beside it, no network and no server: the surface "
        "or the fog from any side, slices, the histogram of the values, the spectrum with what the "
        "filter passes, and what the grid says of its errors. Grids that are too large are reduced "
        "for it by averages, without aliasing. Takes any grid of floats: densities, fog, level "
        "sets.",
        {{"INPUT", "A .vdb file; stdin.vdb is the standard input.", false, {.endings = {".vdb"}}}},
        {
            {"output",
             'o',
             "FILE",
             "",
             "The .html file to write. Needed.",
             "Page",
             {.endings = {".html"}}},
            {"title", 0, "TEXT", "the input's name", "What the page is called.", "Page"},
            {"grid", 0, "NAME", "density, or the only one of floats",
             "Which grid to show; NAME[1] is the second one of that name.", "Volume"},
            {"iso", 0, "D", "as stored, else 0.5",
             "Value that is the surface at first; of a level set the distance, by default 0.",
             "Volume"},
            {"size", 0, "N", std::to_string(kViewSize),
             "Samples along the longest side, 16 to 512; fewer if the grid has fewer voxels.",
             "Volume"},
        },
        {
            {"bandvox view bunny.vdb -o bunny.html", "A page to open in a browser."},
            {"bandvox view bunny.vdb -o bunny.html --size 256 --title \"The bunny\"",
             "With finer detail; the file is about four times as large."},
            {"bandvox convert bunny.obj -o stdout.vdb | bandvox view stdin.vdb -o bunny.html",
             "Without a .vdb file."},
        }};
    return table;
}

void runView(const CommandLine& line) {
    const ViewRequest request = parseView(line);
    CommandRun run(line);
    AtomicFile output(request.output);
    const ViewPage page = summarize(run, request);
    run.warn(doubtsAbout(page), ErrorKind::Result);
    run.writeOutput(output,
                    [&](AtomicFile& file) { writePage(file, viewHtml(page, run.progress())); });
}

}  // namespace bandvox::app

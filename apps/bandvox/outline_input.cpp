#include "outline_input.h"

#include "choose_grid.h"
#include "report_words.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace bandvox::app {
namespace {

const std::string kDensityName = "density";

OutlineInputKind kindOf(const std::string& input) {
    if (extensionOf(input) == ".vdb") return OutlineInputKind::Volume;
    if (isPatchFile(input)) return OutlineInputKind::Patches;
    if (isShape(input) || isMeshFile(input)) return OutlineInputKind::Solid;
    throw Error(ErrorKind::Input, "cannot draw '" + input +
                                      "', by its name; expected a .vdb, free-form surfaces (.bpt, "
                                      ".obj, " +
                                      joined(cadExtensions(), " ") + "), a mesh (" +
                                      joined(meshExtensions(), " ") +
                                      ") or a built-in shape (shape:torus)");
}

void requireUse(const CommandLine& line, const std::vector<std::string>& names, bool isUsed,
                const std::string& what) {
    for (const std::string& name : names) {
        if (isUsed || !line.has(name)) continue;
        std::string message = "option --" + name;
        message += " is for " + what;
        message += ", and there is none among the inputs";
        throw Error(ErrorKind::Usage, message);
    }
}

void addPatches(CommandRun& run, const std::string& input, PatchModel& all) {
    PatchModel model = readPatches(input, run.progress());
    run.say("read     " + input + ": " +
            formatCount(static_cast<std::int64_t>(model.patches.size()), "patch", "patches"));
    run.warn(model.warnings, ErrorKind::Input);
    all.append(std::move(model));
}

openvdb::FloatGrid::ConstPtr readVolume(CommandRun& run, const std::string& input,
                                        const OutlineInputs& inputs) {
    const auto grid = chooseFloatGrid(readGrids(input), inputs.grid, kDensityName, input);
    run.say("read     " + input + ": grid \"" + grid->getName() + "\"");
    warnOfPart(run, *grid, input);
    return grid;
}

openvdb::FloatGrid::ConstPtr makeVolume(CommandRun& run, const std::string& input,
                                        const OutlineInputs& inputs) {
    SolidDensityRequest request;
    request.input = input;
    request.density = inputs.density;
    const DensityResult result = solidToDensity(run, request);
    run.warn(result.warnings, ErrorKind::Result);
    return result.grid;
}

}  // namespace

std::vector<OptionEntry> outlineInputEntries() {
    const std::string group = "Volumes and meshes";
    const DensityOptions density;
    std::vector<OptionEntry> entries{
        {"grid", 0, "NAME", "density, or the only one of floats", "Which grid of a .vdb to draw.",
         group},
        {"iso", 0, "D", "as stored, else 0.5",
         "Density that is the surface, or \"volume\", the one that encloses the volume of the "
         "source; of a level set the distance, by default 0.",
         group},
        {"resolution", 'r', "N", std::to_string(density.resolution),
         "Voxels along the longest side of the box of a mesh, of which a band-limited volume is "
         "made: fewer leave small detail away.",
         group},
        {"voxel-size", 0, "S", "", "The same as the side of a voxel, world units.", group},
    };
    for (OptionEntry entry : filterEntries(density.filter)) {
        entry.group = group;
        entries.push_back(std::move(entry));
    }
    return entries;
}

bool OutlineInputs::has(OutlineInputKind kind) const {
    return std::any_of(files.begin(), files.end(),
                       [&](const auto& file) { return file.second == kind; });
}

OutlineInputs readOutlineInputs(const CommandLine& line) {
    OutlineInputs inputs;
    for (const std::string& file : line.positionals())
        inputs.files.emplace_back(file, kindOf(file));
    const bool hasVolume = inputs.has(OutlineInputKind::Volume);
    const bool hasSolid = inputs.has(OutlineInputKind::Solid);
    requireUse(line, {"grid"}, hasVolume, "volumes (.vdb)");
    requireUse(line, {"resolution", "voxel-size", "cutoff", "order"}, hasSolid,
               "meshes and built-in shapes");
    requireUse(line, {"iso", "suggestive"}, hasVolume || hasSolid, "volumes and meshes");
    requireUse(line, {"crease-angle"}, inputs.has(OutlineInputKind::Patches), "free-form surfaces");
    inputs.grid = line.text("grid");
    inputs.iso = readIso(line, {});
    readSize(line, inputs.density.resolution, inputs.density.voxelSize);
    inputs.density.filter = readFilter(line);
    return inputs;
}

OutlineScene loadOutlineScene(CommandRun& run, const OutlineInputs& inputs) {
    OutlineScene scene;
    for (const auto& [input, kind] : inputs.files) {
        if (kind == OutlineInputKind::Patches) {
            addPatches(run, input, scene.patches);
            continue;
        }
        const std::string name =
            isShape(input) ? input : std::filesystem::path(input).stem().string();
        OutlineVolume volume{.name = name};
        volume.grid = kind == OutlineInputKind::Volume ? readVolume(run, input, inputs)
                                                       : makeVolume(run, input, inputs);
        volume.iso = isoFor(run, inputs.iso, volume.grid);
        scene.volumes.push_back(std::move(volume));
    }
    return scene;
}

}  // namespace bandvox::app

#include "outline_input.h"

#include "choose_grid.h"
#include "density_report.h"
#include "report_words.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace bandvox::app {
namespace {

const std::string kDensityName = "density";

enum class InputKind { Patches, Volume, Solid };

InputKind kindOf(const std::string& input) {
    if (extensionOf(input) == ".vdb") return InputKind::Volume;
    if (isPatchFile(input)) return InputKind::Patches;
    requireMeshOrShape("draw", input);
    return InputKind::Solid;
}

void addPatches(CommandRun& run, const std::string& input, PatchModel& all) {
    PatchModel model = readPatches(input, run.progress());
    run.say("read     " + input + ": " +
            formatCount(static_cast<std::int64_t>(model.patches.size()), "patch", "patches"));
    run.warn(model.warnings, ErrorKind::Input);
    const int shift = static_cast<int>(all.objects.size());
    for (BezierPatch& patch : model.patches) {
        patch.object += shift;
        all.patches.push_back(std::move(patch));
    }
    all.objects.insert(all.objects.end(), model.objects.begin(), model.objects.end());
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
    return {
        {"grid", 0, "NAME", "density, or the only one of floats", "Which grid of a .vdb to draw.",
         group},
        {"iso", 0, "D", "as stored, else 0.5",
         "Density that is the surface; of a level set the distance, by default 0.", group},
        {"resolution", 'r', "N", std::to_string(density.resolution),
         "Voxels along the longest side of the box of a mesh, of which a band-limited volume is "
         "made: fewer leave small detail away.",
         group},
        {"voxel-size", 0, "S", "", "The same as the side of a voxel, world units.", group},
    };
}

OutlineInputs readOutlineInputs(const CommandLine& line) {
    OutlineInputs inputs;
    inputs.files = line.positionals();
    inputs.grid = line.text("grid");
    if (line.has("iso")) inputs.iso = line.number("iso", {}, 0);
    readSize(line, inputs.density.resolution, inputs.density.voxelSize);
    return inputs;
}

OutlineScene loadOutlineScene(CommandRun& run, const OutlineInputs& inputs) {
    OutlineScene scene;
    for (const std::string& input : inputs.files) {
        const InputKind kind = kindOf(input);
        if (kind == InputKind::Patches) {
            addPatches(run, input, scene.patches);
            continue;
        }
        const std::string name =
            isShape(input) ? input : std::filesystem::path(input).stem().string();
        scene.volumes.push_back({kind == InputKind::Volume ? readVolume(run, input, inputs)
                                                           : makeVolume(run, input, inputs),
                                 inputs.iso, name});
    }
    return scene;
}

}  // namespace bandvox::app

#include "output_kind.h"

#include "mesh_output.h"
#include "words.h"

#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/write_mesh.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace bandvox::app {
namespace {

const std::vector<std::string> kKinds{"density", "level-set", "fog", "values"};
constexpr std::size_t kValues = 3;

}  // namespace

std::vector<OptionEntry> outputKindEntries() {
    return {
        {"as",
         0,
         "KIND",
         "density, of a volume values",
         "density: of the solid, 0.5 on its surface. level-set: distances from the density's "
         "surface, true ones. fog: as OpenVDB makes it of those, 0 on the surface and 1 inside. "
         "values: those of a volume, whatever they are.",
         "Output",
         {.words = kKinds}},
        {"band", 0, "W", formatNumber(LevelSetOptions().halfWidth),
         "Half the width of a level set's band, or the depth over which fog rises, in voxels, 1 to "
         "100.",
         "Output"},
    };
}

bool asksForValues(const CommandLine& line) {
    return line.has("as") && line.choice("as", kKinds, kValues) == kValues;
}

std::optional<OutputKind> readOutputKind(const CommandLine& line) {
    OutputKind result;
    const std::size_t choice = line.choice("as", kKinds, kValues);
    result.kind = static_cast<OutputKind::Kind>(choice);
    result.halfWidth = line.number("band", {.low = 1, .high = 100}, LevelSetOptions().halfWidth);
    const bool hasBand = choice != kValues && result.kind != OutputKind::Kind::Density;
    if (hasBand) {
        refuseOptions(line, {"lod", "clamp"}, "with --as level-set or fog");
        if (isWritableMesh(line.text("output").value_or(""))) {
            throw Error(ErrorKind::Usage,
                        "--as level-set or fog is for volumes, and the output is a mesh");
        }
    } else {
        refuseOptions(line, {"band"}, "without --as level-set or fog");
    }
    if (choice == kValues) return std::nullopt;
    return result;
}

openvdb::FloatGrid::Ptr makeOutput(CommandRun& run, const OutputKind& kind,
                                   const openvdb::FloatGrid::Ptr& grid,
                                   const std::optional<double>& iso) {
    if (kind.kind == OutputKind::Kind::Density) return grid;
    LevelSetOptions options;
    options.iso = iso;
    options.halfWidth = kind.halfWidth;
    const LevelSetResult result = densityToLevelSet(grid, options, run.progress());
    const auto voxels = static_cast<std::int64_t>(result.grid->activeVoxelCount());
    run.say("distance " + formatCount(voxels, "voxel", "voxels") + " within " +
            formatNumber(kind.halfWidth) + " voxels of the surface, around a volume of " +
            formatNumber(result.volume, 8));
    run.count("band_voxels", voxels);
    run.count("surface_volume", result.volume);
    run.count("largest_correction", result.largestCorrection);
    if (kind.kind == OutputKind::Kind::Fog) return levelSetToFog(result.grid);
    return result.grid;
}

}  // namespace bandvox::app

#include "color_grid.h"

#include "words.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <set>
#include <utility>

namespace bandvox::app {

ColoredMesh loadColors(CommandRun& run, const std::string& input, MeshFile& plain) {
    ColoredMeshFile file = readColoredMesh(input, run.progress());
    std::set<const Texture*> pictures;
    for (const MeshTexture& texture : file.colored.textures) pictures.insert(texture.picture.get());
    const auto textures = static_cast<std::int64_t>(pictures.size());
    run.sayMore("colours  of " +
                formatCount(static_cast<std::int64_t>(file.triangles), "triangle", "triangles") +
                ", " + formatCount(textures, "texture", "textures"));
    run.count("colored_triangles", file.triangles);
    run.count("textures", textures);
    plain.mesh = file.colored.mesh;
    plain.objects = file.objects;
    plain.warnings = std::move(file.warnings);
    return std::move(file.colored);
}

ColorResult makeColors(CommandRun& run, const ColoredMesh& mesh, const DensityResult& density,
                       const DensityOptions& options) {
    ColorOptions colors;
    colors.voxelSize = density.grid->voxelSize().x();
    colors.filter = options.filter;
    colors.tile = options.tile;
    colors.shard = options.shard;
    return surfaceToColor(mesh, colors, run.progress());
}

void sayColors(CommandRun& run, const ColorResult& result) {
    const auto voxels = static_cast<std::int64_t>(result.grid->activeVoxelCount());
    run.say("color    " + formatCount(voxels, "active voxel", "active voxels") + " of Cd, from " +
            formatCount(result.surfaceSamples, "surface sample", "surface samples"));
    run.count("color_voxels", voxels);
    run.count("color_samples", result.surfaceSamples);
    run.count("color_tiles", result.tiles);
}

}  // namespace bandvox::app

// bandvox convert: whatever describes a volume to a .vdb file, or to a mesh of its surface.

#include "command_run.h"
#include "commands.h"
#include "convert_frames.h"
#include "convert_grid_solid.h"
#include "convert_job.h"
#include "convert_points.h"
#include "convert_settings.h"
#include "convert_to_array.h"
#include "convert_volume.h"
#include "file_endings.h"
#include "memory_limit.h"
#include "mesh_output.h"
#include "output_kind.h"
#include "stack_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/source/shapes.h>

#include <filesystem>
#include <vector>

namespace bandvox::app {

const CommandTable& convertTable() {
    static const CommandTable table = [] {
        const DensityOptions density;
        const std::string filter = "Filter";
        std::vector<OptionEntry> options{resolutionEntry(density.resolution), voxelSizeEntry()};
        const auto add = [&options](const std::vector<OptionEntry>& entries) {
            options.insert(options.end(), entries.begin(), entries.end());
        };
        add(latticeEntries());
        add(gridSolidEntries());
        add(pointEntries());
        add(stackEntries());
        add(filterEntries(density.filter));
        add({
            {"tolerance", 0, "E", formatNumber(density.tolerance),
             "Error of the density that is allowed, 1e-6 to 0.05. On the sampled route its "
             "default is " +
                 formatNumber(FieldDensityOptions().samplingTolerance) + ".",
             filter},
            {"tile", 0, "N", "chosen",
             "Side of the cube that is filtered at a time, in voxels, even, at most 512.", filter},
            {"route",
             0,
             "KIND",
             "auto",
             "exact: from the surface itself, holes capped. sampled: from samples of a shape's "
             "formula, which alias a little. winding: the places that a mesh's triangles wind "
             "around by more than half, followed along rows. auto: exact, but winding for what "
             "of a mesh caps cannot close.",
             filter,
             {.words = {"auto", "exact", "sampled", "winding"}}},
            {"oversample", 0, "P",
             std::to_string(FieldDensityOptions().oversample) + ", winding " +
                 std::to_string(SoupDensityOptions().rowsPerVoxel),
             "Samples along a voxel's side on the sampled route, whose error is measured if "
             "they are even, or rows on that of the winding number, 1 to 64.",
             filter},
            {"overlap",
             0,
             "KIND",
             "union",
             "Where shells of a mesh overlap. union: inside is inside. sum: densities add up, "
             "so that near parts blend into each other.",
             filter,
             {.words = {"union", "sum"}}},
            {"base", 0, "Z", "",
             "Of free-form surfaces that are a height field: the solid between them and the plane "
             "z = Z, with walls.",
             filter},
            {"clamp", 0, "", "", "Limit the density to 0 .. 1, which cuts off ringing.", filter},
            {"iso", 0, "D", formatNumber(density.iso),
             "Value that is the surface, of a mesh or for the commands that come after. Of a .vdb "
             "input it is the one stored there, else 0.5, and 0 of a level set. volume: the value "
             "that encloses the volume of the source.",
             filter},
            {"color", 0, "", "",
             "Write the colours of the mesh beside its density, as a grid Cd, or with the points "
             "of a mesh: those of its points, else of its materials and their textures, in "
             "linear light, filtered as the density is.",
             "Output"},
            meshOrVdbOutputEntry(),
            {"half", 0, "", "",
             "Store 16-bit values, which changes densities by up to 2.5e-4, above 1 by 5e-4.",
             "Output"},
            compressionEntry(),
            memoryLimitEntry(),
            shardEntry(),
            adaptivityEntry(),
        });
        add(outputKindEntries());
        add(frameEntries());
        add(arrayOutputEntries());
        return CommandTable{
            "convert",
            "Turn a mesh, a built-in shape or a volume into a band-limited volume or its surface.",
            "Turns the solid inside a mesh into a density on a grid: 1 inside, 0 outside, and in "
            "between only what the grid can hold. The solid is filtered before it is sampled, so "
            "nothing aliases; the error is measured and stored in the grid. Holes of the mesh are "
            "capped, and said so. The grids of a .vdb file are copied, or filtered for another "
            "lattice: of a density, what its source would have become there. An output that is a "
            "mesh is the surface of the density, or of a .vdb file's level set, closed. Arrays, "
            "stacks "
            "of images and DICOM series come in as grids, and grids go out as arrays and stacks.",
            {{"INPUT",
              "A mesh (.obj, .ply, .stl, .gltf, ...), free-form surfaces (.bpt, .obj, .step), a "
              ".vdb file "
              "(stdin.vdb is the standard "
              "input), an array (.npy, .nrrd, .nhdr, .mha, .mhd), slices (a folder or a pattern "
              "of images, slice.####.tif, or a .tif file with pages), a folder or a file of DICOM, "
              "points (.xyz, .csv, .txt, a .ply without faces), or a built-in shape such as "
              "shape:torus.",
              false,
              {.words = shapeWords(), .endings = convertibleEndings(), .isFolder = true}}},
            options,
            {
                {"bandvox convert bunny.obj -o bunny.vdb --resolution 512",
                 "512 voxels along the bunny's longest side."},
                {"bandvox convert shape:torus -o torus.vdb --order 4 --cutoff 0.25",
                 "A sharper filter, that keeps more detail and rings by 5 %."},
                {"bandvox convert bunny.vdb -o small.vdb --factor 4",
                 "The same on voxels four times as large."},
                {"bandvox convert bunny.vdb -o levels.vdb --lod 3",
                 "With three coarser levels of detail."},
                {"bandvox convert scan.nrrd -o bone.vdb --threshold 300 --factor 2",
                 "What of a scan is above 300, on voxels twice as large."},
                {"bandvox convert bunny.obj -o distances.vdb --as level-set",
                 "Distances from the surface of that."},
                {"bandvox convert particles.csv -o water.vdb --radius 0.05",
                 "The union of balls around points."},
                {"bandvox convert teapot.bpt -o teapot.vdb", "Bézier patches, as they are."},
                {"bandvox convert spot.obj -o spot.vdb --color",
                 "The density, and the colours of the surface around it."},
                {"bandvox convert spot.vdb -o spot.ply", "The surface of that, with its colours."},
                {"bandvox convert scan/ -o scan.vdb --spacing 0.05",
                 "A folder of images of slices, 0.05 world units from voxel to voxel."},
                {"bandvox convert bunny.obj -o bunny.usda",
                 "bunny.vdb, and a USD volume that refers to it."},
                {"bandvox convert bunny.vdb -o slices.####.png",
                 "The density as images, 16 bits a pixel."},
                {"bandvox convert part.stl -o part.vdb --voxel-size 0.1 --strict",
                 "Voxels of a given size, and no result if anything about the mesh is doubtful."},
                {"bandvox convert sim.####.obj -o sim.####.vdb --frames 1-100 --skip-existing",
                 "A hundred frames, but for those that are done already."},
            },
            {{"resolution", "voxel-size", "factor", "onto"},
             {"no-filter", "cutoff"},
             {"no-filter", "order"}}};
    }();
    return table;
}

void runConvert(const CommandLine& given) {
    const CommandLine line = withLikedSettings(given);
    const std::filesystem::path output = line.text("output").value_or("");
    if (extensionOf(output) == ".usda") {
        refuseOptions(line, {"frames", "keep-going", "skip-existing"}, "with a .usda output");
        if (asksForFrames(line)) {
            throw Error(ErrorKind::Usage, "a .usda output is of one volume, and '" +
                                              line.positional(0) +
                                              "' stands for many files; expected one of them");
        }
        const CommandLine volume = line.withFiles(
            line.positional(0), std::filesystem::path(output).replace_extension(".vdb").string());
        CommandRun run(volume);
        ConvertJob job(run, volume, output);
        return convertOne(job);
    }
    if (asksForFrames(line)) return convertFrames(line);
    CommandRun run(line);
    ConvertJob job(run, line);
    convertOne(job);
}

}  // namespace bandvox::app

#include "fit_output.h"

#include "color_grid.h"
#include "density_report.h"
#include "fit_columns.h"
#include "mesh_output.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/render/image.h>
#include <bandvox/scatter/colored_height_field.h>
#include <bandvox/scatter/height_field_source.h>
#include <bandvox/scatter/write_surface.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace bandvox::app {
namespace {

constexpr int kStandardSamples = 257;
constexpr double kStandardMargin = 0.1;

/// Samples along x and y, so many along the longer side, as far apart along both.
std::array<int, 2> samplesOf(const BsplineSurface& surface, int longer) {
    const double width = surface.rectangle().width();
    const double height = surface.rectangle().height();
    const double step = std::max(width, height) / (longer - 1);
    const auto count = [&](double side) {
        return std::max(2, static_cast<int>(std::lround(side / step)) + 1);
    };
    return {count(width), count(height)};
}

/// The colours of the surface on the lattice of its solid's density.
openvdb::GridBase::Ptr colorsOfSolid(CommandRun& run, const FitOutput& request,
                                     const FittedSurface& fitted, const DensityResult& density,
                                     int red) {
    const Rectangle& r = fitted.surface.rectangle();
    const double longer = std::max(r.width(), r.height());
    constexpr double kMostSamples = 4097;
    // A sample for each voxel along the surface's rectangle.
    const double wanted = std::ceil(longer / density.grid->voxelSize()[0]) + 1;
    const auto samples =
        samplesOf(fitted.surface, static_cast<int>(std::clamp(wanted, 2.0, kMostSamples)));
    const ColoredMesh mesh = coloredHeightField(
        std::filesystem::path(fitted.input).filename().string(), fitted.surface, samples, red);
    const ColorResult colors = makeColors(run, mesh, density, request.density);
    sayColors(run, colors);
    return colors.grid;
}

void writeSolid(CommandRun& run, AtomicFile& output, const FitOutput& request,
                const FittedSurface& fitted) {
    const double base = request.base ? *request.base : heightBelow(fitted.surface, kStandardMargin);
    const std::string name = std::filesystem::path(fitted.input).filename().string();
    const auto source = makeHeightFieldSource(name, fitted.surface, base);
    run.say("solid    between the surface and z = " + formatNumber(base) + ", volume " +
            formatNumber(source->volume()));
    run.count("base", base);
    DensityResult density = surfaceToDensity(*source, request.density, run.progress());
    if (request.write.half) {
        density.metadata.storageError = roundToHalf(*density.grid);
        density.metadata.gridVolume = densityIntegral(*density.grid);
        setDensityMetadata(*density.grid, density.metadata);
    }
    sayDensity(run, density,
               formatNumber(density.metadata.closureError, 2) + " measured by closure, tolerance " +
                   formatNumber(density.metadata.tolerance, 2));
    run.warn(density.warnings, ErrorKind::Result);
    openvdb::GridCPtrVec grids{density.grid};
    if (const int red = redColumn(fitted.names); red >= 0) {
        grids.push_back(colorsOfSolid(run, request, fitted, density, red));
    }
    run.writeOutput(output, [&](AtomicFile& file) { writeVdb(file, grids, request.write); });
}

std::vector<std::string> quantityNames() {
    std::vector<std::string> names;
    for (const SurfaceQuantity quantity : surfaceQuantities()) names.push_back(nameOf(quantity));
    return names;
}

std::string quantityWords() {
    return joined(quantityNames(), ", ");
}

std::vector<SurfaceQuantity> readQuantities(const CommandLine& line, FitOutput::Kind kind) {
    const auto text = line.text("quantities");
    if (kind != FitOutput::Kind::Samples && kind != FitOutput::Kind::Picture) {
        refuseOptions(line, {"quantities"}, "with this kind of output");
    }
    if (!text && kind == FitOutput::Kind::Samples) return {SurfaceQuantity::Value};
    std::vector<SurfaceQuantity> quantities;
    if (!text) return quantities;
    for (const std::string_view word : split(*text, ',')) {
        const auto quantity = surfaceQuantityNamed(word);
        if (!quantity) line.fail("quantities", "some of " + quantityWords());
        if (std::find(quantities.begin(), quantities.end(), *quantity) != quantities.end()) {
            line.fail("quantities", "each of them once");
        }
        quantities.push_back(*quantity);
    }
    return quantities;
}

FitOutput::Kind kindOf(const std::filesystem::path& path) {
    const std::string extension = extensionOf(path);
    if (extension == ".bpt") return FitOutput::Kind::Patches;
    if (extension == ".npy") return FitOutput::Kind::Samples;
    if (extension == ".exr") return FitOutput::Kind::Picture;
    if (extension == ".vdb") return FitOutput::Kind::Density;
    if (isWritableMesh(path)) return FitOutput::Kind::Mesh;
    throw Error(ErrorKind::Usage, "output '" + path.string() +
                                      "' is of an unknown kind; expected .bpt, .npy, .exr, .vdb, "
                                      ".obj, .ply, .stl, .gltf or .glb");
}

}  // namespace

std::vector<OptionEntry> fitOutputEntries() {
    std::vector<OptionEntry> entries{
        {"output",
         'o',
         "FILE",
         "",
         "What to write: .bpt Bézier patches of the first value, which are the surface exactly; "
         ".npy samples of all values as doubles, [x][y][value]; .exr height as Z, with normals and "
         "positions; .obj .ply .stl .gltf .glb a mesh with normals; .vdb the density of the solid "
         "under the surface. Columns named r, g and b are the colours of meshes and pictures, and "
         "the grid Cd of a .vdb file. Needed.",
         "Output",
         {.endings = {".bpt", ".npy", ".exr", ".vdb", ".obj", ".ply", ".stl", ".gltf", ".glb"}}},
        {"samples", 0, "N", std::to_string(kStandardSamples),
         "Samples along the longer side of a mesh, a picture or an array, from border to border.",
         "Output"},
        {"quantities",
         0,
         "LIST",
         "value",
         "What an .npy array has of each column, with commas between: " + quantityWords() +
             "; .exr has them of the first as channels besides. With --volume: value, gradient, "
             "which becomes a grid of vectors, as density_gradient.",
         "Output",
         {.words = quantityNames(), .isList = true}},
        resolutionEntry(DensityOptions().resolution),
        voxelSizeEntry(),
        {"base", 0, "Z", "below the surface", "Where the solid of a .vdb file ends below.",
         "Output"},
    };
    for (const OptionEntry& entry : filterEntries(DensityOptions().filter)) {
        entries.push_back(entry);
    }
    entries.push_back({"half", 0, "", "", "Store 16-bit values in a .vdb file.", "Output"});
    entries.push_back(compressionEntry());
    return entries;
}

FitOutput readFitOutput(const CommandLine& line) {
    FitOutput request;
    request.path = outputPath(line.requiredText("output"));
    request.kind = kindOf(request.path);
    constexpr int kMostSamples = 32768;
    request.samples = line.wholeNumber("samples", 2, kMostSamples, kStandardSamples);
    const bool isSampled = request.kind == FitOutput::Kind::Mesh ||
                           request.kind == FitOutput::Kind::Picture ||
                           request.kind == FitOutput::Kind::Samples;
    if (!isSampled) refuseOptions(line, {"samples"}, "with this kind of output");
    request.quantities = readQuantities(line, request.kind);
    if (request.kind != FitOutput::Kind::Density) {
        refuseOptions(
            line, {"resolution", "voxel-size", "base", "cutoff", "order", "half", "compression"},
            "without a .vdb output");
        return request;
    }
    readSize(line, request.density.resolution, request.density.voxelSize);
    request.density.filter = readFilter(line, request.density.filter);
    if (line.has("base")) request.base = line.number("base", kAnyPlace, 0);
    request.write.half = line.has("half");
    request.write.compression = readCompression(line);
    return request;
}

void writeFit(CommandRun& run, AtomicFile& output, const FitOutput& request,
              const FittedSurface& fitted) {
    if (request.kind == FitOutput::Kind::Density) return writeSolid(run, output, request, fitted);
    const BsplineSurface& surface = fitted.surface;
    const int red = redColumn(fitted.names);
    const std::array<int, 2> samples = samplesOf(surface, request.samples);
    run.writeOutput(output, [&](AtomicFile& file) {
        switch (request.kind) {
            case FitOutput::Kind::Patches:
                return writeBezierPatches(file, surface, 0, run.progress());
            case FitOutput::Kind::Samples:
                return writeSamples(file, surface, samples, request.quantities, run.progress());
            case FitOutput::Kind::Picture:
                return writeImage(
                    file,
                    heightFieldImage(surface, samples, 0, red, request.quantities, run.progress()),
                    {.color = red >= 0}, run.progress());
            default:
                return writeMesh(file, heightFieldMesh(surface, samples, 0, red, run.progress()),
                                 run.progress());
        }
    });
}

}  // namespace bandvox::app

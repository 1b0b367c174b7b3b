#include "volume_options.h"

#include "mesh_output.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/mesh/write_mesh.h>

#include <array>

namespace bandvox::app {
namespace {

constexpr int kFinestResolution = 1'000'000;

}  // namespace

OptionEntry resolutionEntry(int standard) {
    return {"resolution",
            'r',
            "N",
            std::to_string(standard),
            "Voxels along the longest side of the object's box.",
            "Size"};
}

OptionEntry voxelSizeEntry() {
    return {"voxel-size", 0, "S", "", "Side of a voxel in world units, instead.", "Size"};
}

OptionEntry vdbOutputEntry() {
    return {"output",
            'o',
            "FILE",
            "",
            "The .vdb file to write; stdout.vdb is the standard output. Needed.",
            "Output",
            {.endings = {".vdb"}}};
}

OptionEntry compressionEntry() {
    return {"compression",
            0,
            "KIND",
            "blosc",
            "blosc, zip or none.",
            "Output",
            {.words = {"blosc", "zip", "none"}}};
}

OptionEntry shardEntry() {
    return {
        "shard",
        0,
        "I/N",
        "",
        "Make part I of N only, from 1, as one of several machines. `bandvox merge` joins the N "
        "files to what one machine would have made.",
        "Output"};
}

Shard readShard(const CommandLine& line) {
    if (!line.has("shard")) return {};
    const auto numbers = line.wholeNumbers("shard", 2, '/');
    const Shard shard{(*numbers)[0], (*numbers)[1]};
    if (shard.index < 1 || shard.index > shard.count || shard.count > 100'000) {
        line.fail("shard", "a part from 1 and the number of all, as in 2/8");
    }
    refuseOptions(line, {"lod", "band"}, "with --shard: it needs the whole");
    if (line.text("iso") == "volume") {
        throw Error(ErrorKind::Usage,
                    "--iso volume has no meaning with --shard: it needs the whole");
    }
    if (isWritableMesh(line.text("output").value_or(""))) {
        throw Error(ErrorKind::Usage,
                    "--shard is for .vdb files as the output, and this is a mesh");
    }
    return shard;
}

void readSize(const CommandLine& line, int& resolution, double& voxelSize) {
    if (line.has("resolution") && line.has("voxel-size")) {
        throw Error(ErrorKind::Usage,
                    "--resolution and --voxel-size exclude each other; expected one of them");
    }
    resolution = line.wholeNumber("resolution", 1, kFinestResolution, resolution);
    voxelSize = line.number("voxel-size", {.low = 0, .lowOpen = true}, voxelSize);
}

std::vector<OptionEntry> filterEntries(const ExponentialFilter& standard) {
    return {
        {"cutoff", 0, "K", formatNumber(standard.cutoff),
         "Cutoff k_c of the filter exp(-(k/k_c)^n), in cycles per voxel, 0.01 to 0.5.", "Filter"},
        {"order", 0, "N", formatNumber(standard.order),
         "Order n of the filter, 1 to 64. 2 never rings; more keeps more detail and overshoots "
         "at flat faces.",
         "Filter"}};
}

ExponentialFilter readFilter(const CommandLine& line, ExponentialFilter standard) {
    standard.cutoff = line.number("cutoff", {.low = 0.01, .high = 0.5}, standard.cutoff);
    standard.order = line.number("order", {.low = 1, .high = 64}, standard.order);
    return standard;
}

VdbWriteOptions::Compression readCompression(const CommandLine& line) {
    using Compression = VdbWriteOptions::Compression;
    return std::array{Compression::Blosc, Compression::Zip,
                      Compression::None}[line.choice("compression", 0)];
}

}  // namespace bandvox::app

#include "volume_options.h"

#include "words.h"

#include <bandvox/core/error.h>

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
            "Output"};
}

OptionEntry compressionEntry() {
    return {"compression", 0, "KIND", "blosc", "blosc, zip or none.", "Output"};
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
                      Compression::None}[line.choice("compression", {"blosc", "zip", "none"}, 0)];
}

}  // namespace bandvox::app

#include "memory_limit.h"

#include "convert_settings.h"
#include "convert_to_array.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <string>

namespace bandvox::app {
namespace {

constexpr std::int64_t kLeast = std::int64_t(1) << 20;

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::Usage,
                "--memory-limit is not for " + what + ": that needs the whole grid in memory");
}

std::string inMebibytes(std::int64_t bytes) {
    constexpr std::int64_t kMebibyte = std::int64_t(1) << 20;
    return std::to_string((bytes + kMebibyte - 1) / kMebibyte) + " MiB";
}

}  // namespace

OptionEntry memoryLimitEntry() {
    return {
        "memory-limit",
        0,
        "SIZE",
        "",
        "Of a solid that becomes a density: hold no more than so much memory at a time, as 800M "
        "or 2G, with binary units. What does not fit lies on the disk meanwhile, beside the "
        "output, which is the same.",
        "Output"};
}

std::int64_t readMemoryLimit(const CommandLine& line) {
    const std::int64_t limit = line.bytes("memory-limit", kLeast, 0);
    if (limit == 0) return 0;
    if (conversionOf(line) != Conversion::SolidToVolume) {
        throw Error(ErrorKind::Usage,
                    "--memory-limit is for a mesh, free-form surfaces or a built-in shape that "
                    "becomes a .vdb file");
    }
    if (isArrayOutput(line.requiredText("output"))) refuse("arrays and images");
    for (const char* option : {"lod", "color", "shard", "band"}) {
        if (line.has(option)) refuse(std::string("--") + option);
    }
    if (line.textOrDefault("as").value_or("density") != "density")
        refuse("--as " + *line.textOrDefault("as"));
    if (line.textOrDefault("iso") == "volume") refuse("--iso volume");
    const std::string route = line.textOrDefault("route").value_or("auto");
    if (route == "sampled" || route == "winding") refuse("--route " + route);
    return limit;
}

void requireReadWithin(std::int64_t limit, std::int64_t before) {
    const std::int64_t peak = peakMemory();
    if (limit == 0 || peak <= limit || peak <= before) return;
    throw Error(ErrorKind::Memory, "to read the input and make it a solid took " +
                                       inMebibytes(peak) + " of memory, more than the limit of " +
                                       inMebibytes(limit) + "; expected a higher --memory-limit");
}

}  // namespace bandvox::app

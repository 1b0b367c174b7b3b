#include "iso_option.h"

#include "words.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/iso_of_volume.h>

#include <nlohmann/json.hpp>

namespace bandvox::app {

IsoOption readIso(const CommandLine& line, const Range& range) {
    IsoOption option;
    option.byVolume = line.text("iso") == "volume";
    if (line.has("iso") && !option.byVolume) option.value = line.number("iso", range, 0);
    return option;
}

std::optional<double> isoFor(CommandRun& run, const IsoOption& option,
                             const openvdb::FloatGrid::ConstPtr& grid) {
    if (!option.byVolume) return option.value;
    const auto metadata = densityMetadata(*grid);
    const bool isKnown = metadata && metadata->sourceVolume > 0;
    const double volume = isKnown ? metadata->sourceVolume : densityIntegral(*grid);
    const VolumeIso found = isoOfVolume(grid, volume, run.progress());
    run.say("iso      " + formatNumber(found.iso) + " encloses a volume of " +
            formatNumber(found.volume, 8) + ", that of the " + (isKnown ? "source" : "values"));
    run.count("iso_volume", found.volume);
    return found.iso;
}

}  // namespace bandvox::app

#pragma once

#include "command_line.h"
#include "command_run.h"

#include <openvdb/openvdb.h>

#include <optional>

namespace bandvox::app {

/// What --iso asks for.
struct IsoOption {
    std::optional<double> value;
    bool byVolume = false;  ///< the value that encloses the volume of the source

    bool isGiven() const { return value || byVolume; }
};

/// --iso: a number in `range`, or "volume".
IsoOption readIso(const CommandLine& line, const Range& range);

/// The value for a grid; nothing if none was asked for. By volume it is that of the source, if the
/// grid knows it, else the integral of its values; what was found is said.
std::optional<double> isoFor(CommandRun& run, const IsoOption& option,
                             const openvdb::FloatGrid::ConstPtr& grid);

}  // namespace bandvox::app

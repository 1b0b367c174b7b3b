#pragma once

#include "command_line.h"
#include "option_table.h"

#include <bandvox/core/shard.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/spectral/exponential_filter.h>

#include <vector>

namespace bandvox::app {

// Options shared by the commands that write a volume.

OptionEntry resolutionEntry(int standard);
OptionEntry voxelSizeEntry();
OptionEntry vdbOutputEntry();
OptionEntry compressionEntry();

/// Sets what --resolution or --voxel-size give. Throws Error(ErrorKind::Usage) if both are there.
void readSize(const CommandLine& line, int& resolution, double& voxelSize);

/// --cutoff and --order.
std::vector<OptionEntry> filterEntries(const ExponentialFilter& standard);
ExponentialFilter readFilter(const CommandLine& line, ExponentialFilter standard = {});

/// The option --shard: the part of the volume that is made.
OptionEntry shardEntry();

/// Throws Error(ErrorKind::Usage) for parts that there cannot be, and for options that need the
/// whole.
Shard readShard(const CommandLine& line);

VdbWriteOptions::Compression readCompression(const CommandLine& line);

}  // namespace bandvox::app

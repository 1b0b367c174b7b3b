#pragma once

#include "command_line.h"
#include "option_table.h"

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

VdbWriteOptions::Compression readCompression(const CommandLine& line);

}  // namespace bandvox::app

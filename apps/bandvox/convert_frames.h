#pragma once

#include "command_line.h"
#include "convert_job.h"
#include "option_table.h"

#include <vector>

namespace bandvox::app {

/// The options of `convert` that are about sequences of frames, and about repeating what was done.
std::vector<OptionEntry> frameEntries();

/// Converts one input to one output.
void convertOne(ConvertJob& job);

/// True if a command line of `convert` is about several frames: --frames is given, or the input's
/// name has a place for a number.
bool asksForFrames(const CommandLine& line);

/// Converts frame after frame; each is written as soon as it is done. Throws what convertOne does,
/// with the frame's number, at the first frame that fails, or with --keep-going at the end.
void convertFrames(const CommandLine& line);

}  // namespace bandvox::app

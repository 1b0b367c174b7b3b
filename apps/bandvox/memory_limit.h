#pragma once

#include "command_line.h"
#include "option_table.h"

#include <cstdint>

namespace bandvox::app {

/// The option --memory-limit.
OptionEntry memoryLimitEntry();

/// What it asks for, bytes; 0 without it. Throws Error(ErrorKind::Usage) for conversions, outputs
/// and options that need the whole grid in memory.
std::int64_t readMemoryLimit(const CommandLine& line);

/// Throws Error(ErrorKind::Memory) if the process has held more than `limit` while it read the
/// input; `before`: the most that it had held until then.
void requireReadWithin(std::int64_t limit, std::int64_t before);

}  // namespace bandvox::app

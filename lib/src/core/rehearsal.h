#pragma once

#include <bandvox/core/progress.h>

#include <cstdint>
#include <functional>
#include <string>

namespace bandvox {

/// What a rehearsal may take.
struct RehearsalLimits {
    std::int64_t seconds = 0;  ///< of one processor's time; ten times that by the clock
    std::int64_t bytes = 0;    ///< of memory, beyond what the process has; 0: any
};

/// Runs `work` in a copy of the process that does not come back, for a library that damaged input
/// can crash, or can make run and grow without end. Nothing that `work` does to memory is seen
/// here. It must not use threads; what it says on the standard streams is lost.
///
/// Returns what went wrong, in words that follow "it" ("crashed with signal 11"), or as `work`
/// itself returns them; empty if nothing did. Where the system has no room for a copy there is no
/// rehearsal, and nothing is wrong. Throws Error(ErrorKind::Interrupted) if the caller of the
/// progress wants the work to stop, Error(ErrorKind::Memory) if the system ended the copy.
std::string rehearse(const std::function<std::string()>& work, const RehearsalLimits& limits,
                     Progress& progress);

}  // namespace bandvox

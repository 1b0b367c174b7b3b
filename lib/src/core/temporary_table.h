#pragma once

#include <string>

namespace bandvox {

/// Notes the path of a temporary file, so that a signal handler can remove it. Returns its slot,
/// or -1 if the path is too long or too many are noted.
int noteTemporary(const std::string& path) noexcept;

/// Takes a path out again; nothing for a slot of -1.
void dropTemporary(int slot) noexcept;

/// Removes all files that are noted. Async-signal-safe.
void removeNotedTemporaries() noexcept;

}  // namespace bandvox

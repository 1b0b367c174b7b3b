#pragma once

#include <filesystem>
#include <string>

namespace bandvox {

/// What the names of temporary files on this machine begin with, as long as it runs: they are
/// ".bandvox-BOOT-PROCESS-NUMBER" and the target's extension. Other machines may write to the same
/// folder, and of their processes nothing can be told here.
const std::string& temporaryPrefix();

/// Takes a temporary file that was just created, open as `descriptor`, for this process. False if
/// it was taken for a leftover in the meantime, and is gone or will be.
bool claimTemporary(int descriptor) noexcept;

/// Removes the temporary files in a folder that processes on this machine have left behind when
/// they were killed. Looks once at each folder as long as the process lives.
void removeLeftovers(const std::filesystem::path& folder);

}  // namespace bandvox

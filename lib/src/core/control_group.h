#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>

namespace bandvox {

inline constexpr std::int64_t kUnlimitedMemory = std::numeric_limits<std::int64_t>::max();

/// Bytes that the control groups of this process (a container, a batch job, and what they are in)
/// leave it, or kUnlimitedMemory. Both versions of the kernel's interface are asked. `root` is
/// where /proc and /sys are.
std::int64_t availableInControlGroups(const std::filesystem::path& root = "/");

}  // namespace bandvox

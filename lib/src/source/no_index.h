#pragma once

#include <cstdint>
#include <limits>

namespace bandvox {

/// Stands where the index of a point, triangle or edge may be, and is none.
inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

}  // namespace bandvox

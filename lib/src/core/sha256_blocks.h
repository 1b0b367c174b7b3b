#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bandvox {

using Sha256State = std::array<std::uint32_t, 8>;
inline constexpr std::size_t kSha256BlockBytes = 64;

/// Brings a state through `count` blocks that follow each other (section 6.2.2 of FIPS 180-4), as
/// quickly as the processor can.
void addSha256Blocks(Sha256State& state, const unsigned char* blocks, std::size_t count);

/// The same, on any processor.
void addSha256BlocksAnywhere(Sha256State& state, const unsigned char* blocks, std::size_t count);

}  // namespace bandvox

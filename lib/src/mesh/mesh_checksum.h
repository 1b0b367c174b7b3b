#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

// The last note of a mesh file is the CRC-32 of the file, of which it counts as zeros itself.
namespace bandvox {

/// The note before the checksum is known.
inline const std::string kChecksumMark = "checksum: ";
inline const std::string kUnknownChecksum = "00000000";

/// CRC-32 of bytes that follow others.
std::uint32_t checksumOf(std::string_view bytes, std::uint32_t before = 0);

/// Puts the checksum where the note has room for it. Throws Error(ErrorKind::Runtime) if the file
/// cannot be written.
void storeChecksum(const std::filesystem::path& path, std::uint32_t checksum);

}  // namespace bandvox

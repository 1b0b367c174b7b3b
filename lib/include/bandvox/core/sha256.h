#pragma once

#include <bandvox/core/progress.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace bandvox {

/// The digest SHA-256 of bytes that come piece by piece (National Institute of Standards and
/// Technology, FIPS 180-4: Secure Hash Standard, 2015): two files of the same digest are the same.
class Sha256 {
  public:
    void add(std::string_view bytes);

    /// The digest of all that was added, as 64 hexadecimal digits, lower case. The last call.
    std::string finish();

  private:
    std::array<std::uint32_t, 8> mState{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> mBlock{};
    std::size_t mFilled = 0;   // bytes in mBlock
    std::uint64_t mBytes = 0;  // added so far
};

/// The digest of a text.
std::string sha256(std::string_view bytes);

/// The digest of a file's content. Throws Error(ErrorKind::Input) if it cannot be read,
/// Error(ErrorKind::Interrupted).
std::string sha256OfFile(const std::filesystem::path& path, Progress& progress = silentProgress());

}  // namespace bandvox

#pragma once

#include <bandvox/core/error.h>

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace bandvox::fuzz {

/// The extension of the format that is tried, with its dot: that in the environment variable
/// BANDVOX_FUZZ_EXTENSION, or `standard`.
inline std::string extension(const std::string& standard) {
    const char* given = std::getenv("BANDVOX_FUZZ_EXTENSION");
    return given != nullptr ? given : standard;
}

/// A file that holds what is tried, for readers that take a path. It is the process's own, in a
/// folder where there is nothing else.
class InputFile {
  public:
    explicit InputFile(const std::string& extension)
        : mFolder(std::filesystem::temp_directory_path() /
                  ("bandvox-fuzz-" + std::to_string(getpid()))),
          mPath(mFolder / ("input" + extension)) {
        std::filesystem::create_directories(mFolder);
    }
    ~InputFile() {
        std::error_code ignored;
        std::filesystem::remove_all(mFolder, ignored);
    }
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    const std::filesystem::path& write(const std::uint8_t* data, std::size_t size) const {
        std::ofstream file(mPath, std::ios::binary);
        file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
        return mPath;
    }

  private:
    std::filesystem::path mFolder, mPath;
};

/// Runs a reader, which may refuse its input. Any other failure is a finding, and ends the process.
template <typename Reader>
void mayRefuse(const Reader& reader) {
    try {
        reader();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input && error.kind() != ErrorKind::Usage) throw;
    }
}

}  // namespace bandvox::fuzz

#pragma once

#include <filesystem>
#include <optional>

namespace bandvox {

/// How many pages a TIFF file has, by the chain of its directories; nothing if it is no such file.
/// Readers take a chain that leads nowhere for its end. Throws Error(ErrorKind::Input) if it does,
/// or if it goes round.
std::optional<int> countTiffPages(const std::filesystem::path& path);

}  // namespace bandvox

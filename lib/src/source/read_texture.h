#pragma once

#include <bandvox/source/texture.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace bandvox {

/// Reads a picture from a file, in linear light: sRGB is decoded, except of floating-point pixels,
/// which are linear already. One channel is grey; alpha is left out. Values are limited to [0, 1].
/// Throws Error(ErrorKind::Input), which says what is wrong with it, if it is missing, no regular
/// file or cannot be read, and Error(ErrorKind::Memory) before allocating if it would not fit.
std::shared_ptr<const Texture> readTexture(const std::filesystem::path& path);

/// The same from a file in memory, of the kind that the extension `kind` ("png") stands for.
std::shared_ptr<const Texture> readTexture(std::span<const std::byte> bytes,
                                           const std::string& kind);

}  // namespace bandvox

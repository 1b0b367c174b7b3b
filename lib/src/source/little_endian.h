#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace bandvox {

/// The number without sign that `size` bytes (up to 8) at `offset` are; they have to be there.
inline std::uint64_t unsignedAt(std::string_view bytes, std::size_t offset, std::size_t size,
                                std::endian order = std::endian::little) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const std::size_t place = order == std::endian::little ? i : size - 1 - i;
        number |= std::uint64_t(static_cast<unsigned char>(bytes[offset + i])) << (8 * place);
    }
    return number;
}

/// The same of four bytes, least first.
inline std::uint32_t littleEndian32(std::string_view bytes, std::size_t offset) {
    return static_cast<std::uint32_t>(unsignedAt(bytes, offset, 4));
}

}  // namespace bandvox

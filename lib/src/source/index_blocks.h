#pragma once

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace bandvox {

inline constexpr std::size_t kIndexBlock = 16384;

/// The number of blocks of so many indices.
inline std::size_t indexBlocks(std::size_t count) {
    return (count + kIndexBlock - 1) / kIndexBlock;
}

/// Calls visit(begin, end), in parallel, for blocks of indices that together are 0 to count - 1.
/// The blocks do not depend on the number of threads.
template <typename Visit>
void forEachIndexBlock(std::size_t count, const Visit& visit) {
    parallelFor(static_cast<std::int64_t>(indexBlocks(count)), [&](std::int64_t block) {
        const std::size_t begin = static_cast<std::size_t>(block) * kIndexBlock;
        visit(begin, std::min(begin + kIndexBlock, count));
    });
}

/// Calls visit(index), in parallel, for each index below count.
template <typename Visit>
void forEachIndex(std::size_t count, const Visit& visit) {
    forEachIndexBlock(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(i);
    });
}

/// The number of indices below count of which holds(index) is true; asks in parallel.
template <typename Holds>
std::size_t countIndices(std::size_t count, const Holds& holds) {
    std::atomic<std::size_t> found = 0;
    forEachIndexBlock(count, [&](std::size_t begin, std::size_t end) {
        std::size_t ofBlock = 0;
        for (std::size_t i = begin; i < end; ++i) ofBlock += holds(i) ? 1 : 0;
        found += ofBlock;
    });
    return found;
}

}  // namespace bandvox

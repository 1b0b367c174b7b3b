#pragma once

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace bandvox {

/// Calls visit(begin, end), in parallel, for blocks of indices that together are 0 to count - 1.
/// The blocks do not depend on the number of threads.
template <typename Visit>
void forEachIndexBlock(std::size_t count, const Visit& visit) {
    constexpr std::size_t kBlock = 16384;
    parallelFor(static_cast<std::int64_t>((count + kBlock - 1) / kBlock), [&](std::int64_t block) {
        const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
        visit(begin, std::min(begin + kBlock, count));
    });
}

/// Calls visit(index), in parallel, for each index below count.
template <typename Visit>
void forEachIndex(std::size_t count, const Visit& visit) {
    forEachIndexBlock(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(i);
    });
}

}  // namespace bandvox

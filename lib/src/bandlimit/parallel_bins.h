#pragma once

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace bandvox {

/// Numbers sorted into bins, in rising order within each. A number may be in several.
struct Bins {
    std::vector<std::uint64_t> start;  ///< of each bin in `items`, and the end
    std::vector<std::uint32_t> items;

    std::span<const std::uint32_t> bin(std::size_t i) const {
        return {items.data() + start[i], items.data() + start[i + 1]};
    }
    /// Bytes.
    std::size_t memory() const {
        return start.size() * sizeof(start[0]) + items.size() * sizeof(items[0]);
    }
};

/// Sorts the numbers below `count` into `binCount` bins, in parallel: forEachBin(i, visit) calls
/// visit(bin) for each bin that number i belongs to, always the same ones.
template <typename ForEachBin>
Bins sortIntoBins(std::size_t count, std::size_t binCount, const ForEachBin& forEachBin) {
    // Of many bins fewer and larger parts of the numbers, so that the counts stay few.
    constexpr std::size_t kSmallestPart = std::size_t{1} << 16, kMostCounts = std::size_t{1} << 22;
    const std::size_t mostParts =
        std::max<std::size_t>(1, kMostCounts / std::max<std::size_t>(binCount, 1));
    const std::size_t part = std::max(kSmallestPart, (count + mostParts - 1) / mostParts);
    const std::size_t parts = (count + part - 1) / part;
    std::vector<std::uint64_t> next(parts * binCount, 0);
    const auto forEachOfPart = [&](std::int64_t i, const auto& visit) {
        const std::size_t begin = static_cast<std::size_t>(i) * part;
        std::uint64_t* row = next.data() + static_cast<std::size_t>(i) * binCount;
        for (std::size_t n = begin; n < std::min(begin + part, count); ++n) {
            forEachBin(n, [&](std::size_t bin) { visit(static_cast<std::uint32_t>(n), row[bin]); });
        }
    };

    // Count, and turn the counts into places; then place.
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t i) {
        forEachOfPart(i, [](std::uint32_t, std::uint64_t& n) { ++n; });
    });
    Bins bins;
    bins.start.assign(binCount + 1, 0);
    std::uint64_t sum = 0;
    for (std::size_t bin = 0; bin < binCount; ++bin) {
        for (std::size_t i = 0; i < parts; ++i) {
            std::uint64_t& n = next[i * binCount + bin];
            n = std::exchange(sum, sum + n);
        }
        bins.start[bin + 1] = sum;
    }
    bins.items.resize(sum);
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t i) {
        forEachOfPart(i, [&](std::uint32_t number, std::uint64_t& n) { bins.items[n++] = number; });
    });
    return bins;
}

}  // namespace bandvox

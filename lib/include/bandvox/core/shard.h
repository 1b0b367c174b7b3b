#pragma once

#include <cstdint>

namespace bandvox {

/// A part of work that several machines share: number `index`, from 1, of `count`.
struct Shard {
    int index = 1;
    int count = 1;

    bool isWhole() const { return count == 1; }

    /// True if step `i` of the work belongs to this part: they are dealt out one by one, since
    /// neighbours take about as long.
    bool holds(std::int64_t i) const { return i % count == index - 1; }
};

/// Throws Error(ErrorKind::Usage) unless 1 ≤ index ≤ count ≤ 100 000.
void requireValid(const Shard& shard);

}  // namespace bandvox

#pragma once

#include <cstdint>

namespace bandvox {

/// A part of work that several machines share: number `index`, from 1, of `count`.
struct Shard {
    int index = 1;
    int count = 1;

    bool isWhole() const { return count == 1; }

    /// True if step `i` of `steps` belongs to this part: a run of them, as long as the others to
    /// within one.
    bool holds(std::int64_t i, std::int64_t steps) const {
        return i >= (index - 1) * steps / count && i < index * steps / count;
    }
};

/// Throws Error(ErrorKind::Usage) unless 1 ≤ index ≤ count ≤ 100 000.
void requireValid(const Shard& shard);

}  // namespace bandvox

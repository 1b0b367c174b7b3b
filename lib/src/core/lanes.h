#pragma once

#include <cstring>

// Short vectors of floats that stay in registers, whatever instruction set a loop is compiled for:
// the compilers' vector extension, whose types come apart where the machine's vectors are shorter.
namespace bandvox {

template <int kLanes>
struct LanesOf {
    using Type [[gnu::vector_size(kLanes * sizeof(float))]] = float;
};

/// `kLanes`, a power of two, floats that are added and multiplied at once.
template <int kLanes>
using Lanes = typename LanesOf<kLanes>::Type;

/// Reads lanes from anywhere; by reference, since how vectors are handed over depends on the
/// instruction set.
template <int kLanes>
[[gnu::always_inline]] inline void loadLanes(const float* from, Lanes<kLanes>& lanes) {
    std::memcpy(&lanes, from, sizeof(lanes));
}

template <int kLanes>
[[gnu::always_inline]] inline void storeLanes(const Lanes<kLanes>& lanes, float* to) {
    std::memcpy(to, &lanes, sizeof(lanes));
}

}  // namespace bandvox

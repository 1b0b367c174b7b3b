#pragma once

namespace bandvox {

/// Of a row of n/2 complex numbers Z, the i conj Z(-k) at each k: the floats in reverse order, but
/// for those of k = 0. n is even.
[[gnu::always_inline]] inline void mirrorPacked(const float* row, int n, float* mirrored) {
    mirrored[0] = row[1];
    mirrored[1] = row[0];
    for (int i = 2; i < n; ++i) mirrored[i] = row[n + 1 - i];
}

}  // namespace bandvox

#pragma once

namespace bandvox {

/// Of a row of n/2 complex numbers Z, the i conj Z(-k) at each k, which are its floats in reverse
/// order, but for those of k = 0. n is even.
[[gnu::always_inline]] inline void turnedConjugates(const float* row, int n, float* turned) {
    turned[0] = row[1];
    turned[1] = row[0];
    for (int i = 2; i < n; ++i) turned[i] = row[n + 1 - i];
}

}  // namespace bandvox

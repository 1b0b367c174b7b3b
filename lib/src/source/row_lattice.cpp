#include "source/row_lattice.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace bandvox {

namespace {

// The square of the length of the shortest wave vector, other than along an axis, for which all
// points (i, a i mod n) / n have one phase: of whole (p, q) with p + a q divisible by n.
int shortestDual(int n, int a) {
    int shortest = 2 * n * n;
    for (int q = 1; q <= n; ++q) {
        const int rest = a * q % n;
        const int p = std::min(rest, n - rest);
        if (p != 0) shortest = std::min(shortest, p * p + q * q);
    }
    return shortest;
}

int bestGenerator(int n) {
    int best = 1, longest = 0;
    for (int a = 1; a < n; ++a) {
        if (std::gcd(a, n) != 1) continue;
        const int length = shortestDual(n, a);
        if (length > longest) {
            longest = length;
            best = a;
        }
    }
    return best;
}

}  // namespace

RowLattice RowLattice::ofRank1(double voxelSize, int perSide) {
    const int n = perSide * perSide;
    const int a = bestGenerator(n);
    RowLattice lattice{voxelSize, perSide, {}};
    for (int i = 0; i < n; ++i) {
        lattice.rows.push_back({(i + 0.5) / n, (a * i % n + 0.5) / n});
    }
    return lattice;
}

}  // namespace bandvox

#include "source/row_lattice.h"

namespace bandvox {

RowLattice RowLattice::turned(double voxelSize, int perSide) {
    const int n = perSide * perSide + 1;
    RowLattice lattice{voxelSize, perSide, {}};
    for (int i = 0; i < n; ++i) {
        lattice.rows.push_back({(i + 0.5) / n, (perSide * i % n + 0.5) / n});
    }
    return lattice;
}

bool RowLattice::isOfWiderLattice(int y, int z, int row) const {
    // The row is u (1, P) + v (0, n), up to a shift that all have in common.
    const int n = rowCount();
    const int u = y * n + row;
    const int v = z - perSide * y - perSide * row / n;
    return (u & 1) == 0 && (v & 1) == 0;
}

}  // namespace bandvox

#include "mesh/cell_polygons.h"

#include <limits>

namespace bandvox {

namespace {

constexpr int kEdges = 12;
constexpr int kFaces = 6;
constexpr double kImpossible = std::numeric_limits<double>::infinity();

// Diagonals that lie in a face of the cell are taken only where there is no other way.
constexpr double kInFaceCost = 1e3;

/// The corners and edges of a cell by number.
struct CellTable {
    std::array<int, kEdges> lower{};                   // corner of each edge
    std::array<std::array<int, 8>, 8> edgeOf{};        // of two corners
    std::array<std::array<int, 4>, kFaces> corners{};  // of a face, counter-clockwise from outside
    std::array<unsigned, kEdges> faces{};              // that an edge belongs to, one bit each
};

constexpr CellTable makeCellTable() {
    CellTable table;
    int edge = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 8; ++corner) {
            if ((corner >> axis & 1) != 0) continue;
            const int other = corner | 1 << axis;
            table.lower[edge] = corner;
            table.edgeOf[corner][other] = table.edgeOf[other][corner] = edge;
            for (int across = 0; across < 3; ++across) {
                if (across == axis) continue;
                table.faces[edge] |= 1U << (2 * across + (corner >> across & 1));
            }
            ++edge;
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << (axis + 1) % 3;
        const int v = 1 << (axis + 2) % 3;
        for (int side = 0; side < 2; ++side) {
            const int base = side << axis;
            table.corners[2 * axis + side] = {base, base | (side == 1 ? u : v), base | u | v,
                                              base | (side == 1 ? v : u)};
        }
    }
    return table;
}

constexpr CellTable kCell = makeCellTable();

// The faces on the upper sides of a cell.
constexpr unsigned kUpperFaces = 0b101010;

// The steps of rings over a face: to each edge where the walk around the face leaves the inside,
// from the edge where it has come in.
void stepsOnFace(int face, unsigned inside, bool joined, std::array<int, kEdges>& next) {
    const std::array<int, 4>& corners = kCell.corners[face];
    const auto isInside = [&](int k) { return (inside >> corners[k % 4] & 1) != 0; };
    for (int k = 0; k < 4; ++k) {
        if (!isInside(k) || isInside(k + 1)) continue;
        // Back along the run of corners inside, or, where the inside is one, on to the next run.
        int in = k;
        const bool isAmbiguous = !isInside(k + 3) && isInside(k + 2);
        if (isAmbiguous && joined) {
            in = k + 1;
        } else {
            do {
                in = (in + 3) % 4;
            } while (isInside(in));
        }
        const int from = kCell.edgeOf[corners[in % 4]][corners[(in + 1) % 4]];
        next[from] = kCell.edgeOf[corners[k]][corners[(k + 1) % 4]];
    }
}

double diagonalCost(int a, int b, const openvdb::Vec3d& from, const openvdb::Vec3d& to) {
    const unsigned shared = kCell.faces[a] & kCell.faces[b];
    const double square = (to - from).lengthSqr();
    if (shared == 0) return square;
    // Of the two cells at a face only the one below it may have a diagonal there.
    return (shared & ~kUpperFaces) != 0 ? kImpossible : kInFaceCost * square;
}

}  // namespace

int lowerCorner(int edge) {
    return kCell.lower[edge];
}

unsigned facesToDecide(unsigned inside) {
    unsigned ambiguous = 0;
    for (int face = 0; face < kFaces; ++face) {
        const std::array<int, 4>& corners = kCell.corners[face];
        const auto at = [&](int k) { return inside >> corners[k] & 1; };
        if (at(0) == at(2) && at(1) == at(3) && at(0) != at(1)) ambiguous |= 1U << face;
    }
    return ambiguous;
}

CellPolygons traceCell(unsigned inside, unsigned joined) {
    constexpr int kNone = -1;
    std::array<int, kEdges> next;
    next.fill(kNone);
    for (int face = 0; face < kFaces; ++face) {
        stepsOnFace(face, inside, (joined >> face & 1) != 0, next);
    }
    CellPolygons polygons{};
    int end = 0;
    for (int start = 0; start < kEdges; ++start) {
        if (next[start] == kNone) continue;
        const int begin = end;
        for (int edge = start; next[edge] != kNone;) {
            polygons.edges[end++] = static_cast<std::uint8_t>(edge);
            const int following = next[edge];
            next[edge] = kNone;
            edge = following;
        }
        polygons.sizes[polygons.rings++] = static_cast<std::uint8_t>(end - begin);
    }
    return polygons;
}

bool cutRing(std::span<const std::uint8_t> ring, std::span<const openvdb::Vec3d> places,
             std::vector<openvdb::Vec3I>& triangles) {
    const int n = static_cast<int>(ring.size());
    // Most rings have one or two triangles.
    if (n == 3) {
        triangles.emplace_back(0, 1, 2);
        return true;
    }
    double side[kEdges][kEdges] = {};
    for (int i = 0; i < n; ++i) {
        for (int j = i + 2; j < n; ++j) {
            if (i == 0 && j == n - 1) continue;
            side[i][j] = diagonalCost(ring[i], ring[j], places[i], places[j]);
        }
    }
    // The least cost of what lies between i and j, from short parts of the ring to long ones.
    double least[kEdges][kEdges] = {};
    int apex[kEdges][kEdges] = {};
    for (int length = 2; length < n; ++length) {
        for (int i = 0; i + length < n; ++i) {
            const int j = i + length;
            least[i][j] = kImpossible;
            for (int k = i + 1; k < j; ++k) {
                const double cost = least[i][k] + least[k][j] + side[i][k] + side[k][j];
                if (!(cost < least[i][j])) continue;
                least[i][j] = cost;
                apex[i][j] = k;
            }
        }
    }
    if (least[0][n - 1] == kImpossible) return false;
    std::array<std::pair<int, int>, kEdges> open{{{0, n - 1}}};
    for (int count = 1; count > 0;) {
        const auto [i, j] = open[--count];
        const int k = apex[i][j];
        triangles.emplace_back(i, k, j);
        if (k - i > 1) open[count++] = {i, k};
        if (j - k > 1) open[count++] = {k, j};
    }
    return true;
}

}  // namespace bandvox

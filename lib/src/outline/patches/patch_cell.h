#pragma once

#include "outline/patches/vectors.h"
#include "outline/patches/view_patch.h"
#include "source/control_net.h"

#include <array>

namespace bandvox {

/// A square of a patch's parameters with what encloses it in the space of the view: all bounds come
/// from its control points.
struct PatchCell {
    int patch = 0;
    double u0 = 0, v0 = 0, size = 1;
    int m = 0, n = 0;           ///< degrees by u and v
    ControlNet<4> homogeneous;  ///< (wx, wy, wz, w); empty if not rational
    ControlNet<3> points;       ///< (m + 1) * (n + 1), [u][v]
    Vec low{}, high{};
    Cone alongU, alongV;  ///< of the derivatives by u and v
    Cone normals;
    bool hasCones = false;  ///< only what is near another cell needs them

    const Vec& at(int i, int j) const {
        return points[static_cast<std::size_t>(i) * static_cast<std::size_t>(n + 1) +
                      static_cast<std::size_t>(j)];
    }
    double extent() const;

    /// Whether no two places of the cell are in the same place.
    bool isOneToOne() const { return areApart(alongU, alongV); }
};

/// With its cones.
PatchCell cellOf(const ViewPatch& patch, int index);

/// The quarters: (low u, low v), (low, high), (high, low), (high, high).
/// Without cones.
std::array<PatchCell, 4> quartersOf(const PatchCell& cell);

/// Finds the cones of a cell that has none.
void completeCell(PatchCell& cell);

/// Whether boxes have nothing in common.
bool areBoxesApart(const PatchCell& a, const PatchCell& b, double reach);

/// What is known of where two cells meet.
enum class CellRelation {
    Apart,        ///< nowhere, but for a side or a corner that they share
    Transversal,  ///< their normals are nowhere parallel: no curve closes, or touches
    Unknown
};

/// Of cells with cones. `reach`: within which points are the same.
CellRelation relationOf(const PatchCell& a, const PatchCell& b, double reach);

}  // namespace bandvox

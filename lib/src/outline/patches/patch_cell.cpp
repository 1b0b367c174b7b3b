// Where patches cannot meet. Cones of normals from cones of derivatives: T. Sederberg and
// R. Meyers, "Loop detection in surface patch intersections", 1988.

#include "outline/patches/patch_cell.h"

#include <optional>
#include <vector>

namespace bandvox {
namespace {

template <std::size_t kRows>
std::array<ControlNet<kRows>, 4> quarterNets(const ControlNet<kRows>& net, int m, int n) {
    std::array<ControlNet<kRows>, 4> q;
    q[0] = net;
    q[2] = halveNet(q[0], m, n, true);
    q[1] = halveNet(q[0], m, n, false);
    q[3] = halveNet(q[2], m, n, false);
    return q;
}

// A cone of directions with lengths; those of no length do not count.
class ConeMaker {
  public:
    explicit ConeMaker(std::size_t most) { mDirections.reserve(most); }

    void add(const Vec& d) {
        const double length = lengthOf(d);
        mLongest = std::max(mLongest, length);
        mDirections.push_back({d[0], d[1], d[2], length});
    }
    Cone make() {
        Cone cone;
        if (!(mLongest > 0)) return cone;
        cone.isEmpty = false;
        const double least = 1e-9 * mLongest;
        std::erase_if(mDirections, [&](const auto& d) { return !(d[3] > least); });
        Vec sum{};
        for (auto& d : mDirections) {
            for (std::size_t c = 0; c < 3; ++c) sum[c] += d[c] /= d[3];
        }
        const double whole = lengthOf(sum);
        if (!(whole > 1e-6)) return cone;
        cone.axis = times(1 / whole, sum);
        double cosine = 1;
        for (const auto& d : mDirections) {
            cosine =
                std::min(cosine, d[0] * cone.axis[0] + d[1] * cone.axis[1] + d[2] * cone.axis[2]);
        }
        // Rounding is not to make a cone of one direction a point.
        cone.halfAngle = std::acos(std::clamp(cosine, -1.0, 1.0)) + 1e-7;
        return cone;
    }

  private:
    std::vector<std::array<double, 4>> mDirections;
    double mLongest = 0;
};

Cone normalCone(const Cone& u, const Cone& v) {
    Cone cone;
    cone.isEmpty = false;
    const Vec axis = cross(u.axis, v.axis);
    const double sine = lengthOf(axis);
    if (u.isEmpty || v.isEmpty || !u.isConvex() || !v.isConvex() || !(sine > 0)) return cone;
    const double cosine = std::abs(dot(u.axis, v.axis));
    const double a = std::sin(u.halfAngle), b = std::sin(v.halfAngle);
    const double opening = std::sqrt(a * a + 2 * a * b * cosine + b * b) / sine;
    if (!(opening < 1) || angleBetweenLines(u.axis, v.axis) <= u.halfAngle + v.halfAngle) {
        return cone;
    }
    cone.axis = times(1 / sine, axis);
    cone.halfAngle = std::asin(opening);
    return cone;
}

void boundCell(PatchCell& cell) {
    if (!cell.homogeneous.empty()) {
        cell.points.resize(cell.homogeneous.size());
        for (std::size_t k = 0; k < cell.points.size(); ++k) {
            const auto& h = cell.homogeneous[k];
            cell.points[k] = {h[0] / h[3], h[1] / h[3], h[2] / h[3]};
        }
    }
    cell.low = cell.high = cell.points[0];
    for (const Vec& p : cell.points) {
        for (std::size_t c = 0; c < 3; ++c) {
            cell.low[c] = std::min(cell.low[c], p[c]);
            cell.high[c] = std::max(cell.high[c], p[c]);
        }
    }
}

void makeCones(PatchCell& cell) {
    ConeMaker u(cell.points.size()), v(cell.points.size());
    for (int i = 0; i <= cell.m; ++i) {
        for (int j = 0; j <= cell.n; ++j) {
            if (i < cell.m) u.add(minus(cell.at(i + 1, j), cell.at(i, j)));
            if (j < cell.n) v.add(minus(cell.at(i, j + 1), cell.at(i, j)));
        }
    }
    cell.alongU = u.make();
    cell.alongV = v.make();
    cell.normals = normalCone(cell.alongU, cell.alongV);
    cell.hasCones = true;
}

// Of the control points' sides along a direction.
std::array<double, 2> spanAlong(const PatchCell& cell, const Vec& d) {
    std::array<double, 2> span{dot(cell.points[0], d), dot(cell.points[0], d)};
    for (const Vec& p : cell.points) {
        const double s = dot(p, d);
        span[0] = std::min(span[0], s);
        span[1] = std::max(span[1], s);
    }
    return span;
}

bool isSeparatedAlong(const PatchCell& a, const PatchCell& b, const Vec& d) {
    const auto s = spanAlong(a, d), t = spanAlong(b, d);
    return s[0] > t[1] || t[0] > s[1];
}

bool isSamePoint(const Vec& a, const Vec& b, double reach) {
    const Vec d = minus(a, b);
    return std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}) <= reach;
}

// The control point k of a side, as of its last + 1.
const Vec& sidePoint(const PatchCell& cell, int side, int k) {
    if (side < 2) return cell.at(side == 0 ? 0 : cell.m, k);
    return cell.at(k, side == 2 ? 0 : cell.n);
}
int lastOf(const PatchCell& cell, int side) {
    return side < 2 ? cell.n : cell.m;
}

// Whether a side of a is one of b.
bool isSameCellSide(const PatchCell& a, int sideA, const PatchCell& b, int sideB, double reach) {
    const int last = lastOf(a, sideA);
    if (lastOf(b, sideB) != last) return false;
    if (isSamePoint(sidePoint(a, sideA, 0), sidePoint(a, sideA, last), reach)) return false;
    for (const bool isReversed : {false, true}) {
        bool isSame = true;
        for (int k = 0; k <= last && isSame; ++k) {
            isSame = isSamePoint(sidePoint(a, sideA, k),
                                 sidePoint(b, sideB, isReversed ? last - k : k), reach);
        }
        if (isSame) return true;
    }
    return false;
}

// The directions in which a cell leaves one of its sides.
Cone awayFrom(const PatchCell& cell, int side) {
    const Cone& across = side < 2 ? cell.alongU : cell.alongV;
    return side % 2 == 0 ? across : opposite(across);
}

// A place of a and one of b differ by a step across the side, from both cells, and one along it:
// if these cannot cancel, both cells meet only in the side.
bool meetOnlyInSide(const PatchCell& a, int sideA, const PatchCell& b, int sideB) {
    ConeMaker side(static_cast<std::size_t>(lastOf(a, sideA)));
    for (int k = 0; k < lastOf(a, sideA); ++k) {
        side.add(minus(sidePoint(a, sideA, k + 1), sidePoint(a, sideA, k)));
    }
    const Cone across = united(opposite(awayFrom(a, sideA)), awayFrom(b, sideB));
    return areApart(side.make(), across);
}

std::optional<Vec> commonCorner(const PatchCell& a, const PatchCell& b, double reach) {
    for (const int i : {0, a.m}) {
        for (const int j : {0, a.n}) {
            for (const int k : {0, b.m}) {
                for (const int l : {0, b.n}) {
                    if (isSamePoint(a.at(i, j), b.at(k, l), reach)) return a.at(i, j);
                }
            }
        }
    }
    return std::nullopt;
}

// Whether a plane through the corner has a on one side, and b on the other one.
bool meetOnlyInCorner(const PatchCell& a, const PatchCell& b, const Vec& corner, double reach) {
    const auto mean = [&](const PatchCell& cell) {
        Vec sum{};
        for (const Vec& p : cell.points) {
            const Vec d = minus(p, corner);
            const double length = lengthOf(d);
            if (length > reach) sum = plus(sum, times(1 / length, d));
        }
        const double length = lengthOf(sum);
        return length > 0 ? times(1 / length, sum) : sum;
    };
    const Vec d = minus(mean(a), mean(b));
    const auto isBeyond = [&](const PatchCell& cell, double sign) {
        return std::all_of(cell.points.begin(), cell.points.end(), [&](const Vec& p) {
            return sign * dot(minus(p, corner), d) > 0 || isSamePoint(p, corner, reach);
        });
    };
    return isBeyond(a, 1) && isBeyond(b, -1);
}

}  // namespace

double PatchCell::extent() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

PatchCell cellOf(const ViewPatch& patch, int index) {
    PatchCell cell;
    cell.patch = index;
    cell.m = patch.x.m;
    cell.n = patch.x.n;
    const bool isRational = patch.w.c.size() > 1;
    cell.points.resize(patch.x.c.size());
    if (isRational) cell.homogeneous.resize(patch.x.c.size());
    for (std::size_t k = 0; k < patch.x.c.size(); ++k) {
        cell.points[k] = {patch.x.c[k], patch.y.c[k], patch.z.c[k]};
        if (isRational) {
            cell.homogeneous[k] = {patch.x.c[k], patch.y.c[k], patch.z.c[k], patch.w.c[k]};
        }
    }
    boundCell(cell);
    makeCones(cell);
    return cell;
}

std::array<PatchCell, 4> quartersOf(const PatchCell& cell) {
    std::array<PatchCell, 4> result;
    const bool isRational = !cell.homogeneous.empty();
    std::array<ControlNet<4>, 4> homogeneous;
    std::array<ControlNet<3>, 4> points;
    if (isRational) {
        homogeneous = quarterNets(cell.homogeneous, cell.m, cell.n);
    } else {
        points = quarterNets(cell.points, cell.m, cell.n);
    }
    for (std::size_t q = 0; q < 4; ++q) {
        PatchCell& quarter = result[q];
        quarter.patch = cell.patch;
        quarter.size = 0.5 * cell.size;
        quarter.u0 = cell.u0 + (q >= 2 ? quarter.size : 0);
        quarter.v0 = cell.v0 + (q % 2 == 1 ? quarter.size : 0);
        quarter.m = cell.m;
        quarter.n = cell.n;
        quarter.homogeneous = std::move(homogeneous[q]);
        quarter.points = std::move(points[q]);
        boundCell(quarter);
    }
    return result;
}

void completeCell(PatchCell& cell) {
    if (!cell.hasCones) makeCones(cell);
}

bool areBoxesApart(const PatchCell& a, const PatchCell& b, double reach) {
    for (std::size_t c = 0; c < 3; ++c) {
        if (a.low[c] > b.high[c] + reach || b.low[c] > a.high[c] + reach) return true;
    }
    return false;
}

CellRelation relationOf(const PatchCell& a, const PatchCell& b, double reach) {
    if (areBoxesApart(a, b, reach)) return CellRelation::Apart;
    for (const PatchCell* cell : {&a, &b}) {
        if (cell->normals.isConvex() && isSeparatedAlong(a, b, cell->normals.axis)) {
            return CellRelation::Apart;
        }
    }
    if (const auto corner = commonCorner(a, b, reach)) {
        for (int sideA = 0; sideA < 4; ++sideA) {
            for (int sideB = 0; sideB < 4; ++sideB) {
                if (isSameCellSide(a, sideA, b, sideB, reach)) {
                    return meetOnlyInSide(a, sideA, b, sideB) ? CellRelation::Apart
                                                              : CellRelation::Unknown;
                }
            }
        }
        return meetOnlyInCorner(a, b, *corner, reach) ? CellRelation::Apart : CellRelation::Unknown;
    }
    return areApart(a.normals, b.normals) ? CellRelation::Transversal : CellRelation::Unknown;
}

}  // namespace bandvox

#include "source/patch_source.h"

#include "source/region_clip.h"

#include <algorithm>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// A rule that is accurate on a flat cell of some voxels, where a wave turns by so many radians,
/// is as accurate on a curved one if the turning of the surface is counted in. At the highest
/// frequencies that filters keep, 0.3 cycles a voxel, a radian takes half a voxel; twice that
/// pays for the waves being bent as well.
constexpr double kVoxelsPerRadian = 1.0;

/// Halvings after which a cell is taken as it is.
constexpr int kDeepestCellSplit = 64;

/// Longest side of a cell that others may cut, voxels.
constexpr double kCutCell = 1.0;

/// Sides that are shorter are points, voxels.
constexpr double kPointSide = 1e-9;

/// Cells that others may cut and that are shorter than this are taken as they are, voxels: beside
/// a side that is a point directions turn however small a cell is.
constexpr double kTinyCutCell = 0.02;

/// What stays the same while a patch is being split.
struct PatchSampling {
    const Patch& patch;
    double voxelSize;
    const SurfaceQuadrature& quadrature;
    RegionClip clip;
    std::vector<SurfaceSample>& samples;
    const CellTrim* trim = nullptr;  ///< null where all of the patch counts
};

/// How large a cell is for quadrature along each parameter: voxels, turning included.
struct CellSize {
    double u = 0, v = 0;
    double length = 0;  ///< of the longer side, without turning
};

/// By how much the direction from a to b to c turns, radians; 0 where there is no direction.
double turning(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto chord = [](const Vec3d& p, const Vec3d& q) {
        const double scale = p.length() * q.length();
        // |p̂ - q̂|² = 2 (1 - cos); the chord is the angle to first order.
        return scale > 0.0 ? std::sqrt(std::max(0.0, 2.0 - 2.0 * p.dot(q) / scale)) : 0.0;
    };
    return chord(a, b) + chord(b, c);
}

double simpson(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return (a.length() + 4.0 * b.length() + c.length()) / 6.0;
}

CellSize measure(const ParameterCell& cell, const PatchSampling& sampling) {
    const double us[3] = {cell.u0, 0.5 * (cell.u0 + cell.u1), cell.u1};
    const double vs[3] = {cell.v0, 0.5 * (cell.v0 + cell.v1), cell.v1};
    PatchPoint p[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) p[i][j] = sampling.patch.at(us[i], vs[j]);
    }

    const double uScale = (cell.u1 - cell.u0) / sampling.voxelSize;
    const double vScale = (cell.v1 - cell.v0) / sampling.voxelSize;
    CellSize size;
    for (int i = 0; i < 3; ++i) {
        const double uLength = uScale * simpson(p[0][i].du, p[1][i].du, p[2][i].du);
        const double vLength = vScale * simpson(p[i][0].dv, p[i][1].dv, p[i][2].dv);
        double uTurn = turning(p[0][i].dv, p[1][i].dv, p[2][i].dv);
        double vTurn = turning(p[i][0].du, p[i][1].du, p[i][2].du);
        // Along a side that is a point rounding alone has a direction.
        if (uLength > kPointSide) {
            uTurn = std::max(uTurn, turning(p[0][i].du, p[1][i].du, p[2][i].du));
        }
        if (vLength > kPointSide) {
            vTurn = std::max(vTurn, turning(p[i][0].dv, p[i][1].dv, p[i][2].dv));
        }
        size.u = std::max(size.u, uLength + kVoxelsPerRadian * uTurn);
        size.v = std::max(size.v, vLength + kVoxelsPerRadian * vTurn);
        size.length = std::max({size.length, uLength, vLength});
    }
    return size;
}

/// The lowest rule that is accurate on this length, or kIntervalRules.
int lowestIntervalRule(const SurfaceQuadrature& quadrature, double length) {
    const auto& sides = quadrature.cellSide;
    return static_cast<int>(
        std::find_if(sides.begin(), sides.end(), [length](double s) { return s >= length; }) -
        sides.begin());
}

void applyRules(int uRule, int vRule, const ParameterCell& cell, const PatchSampling& sampling) {
    const double du = cell.u1 - cell.u0;
    const double dv = cell.v1 - cell.v0;
    const double lengthScale = 1.0 / sampling.voxelSize;
    const double areaScale = du * dv * lengthScale * lengthScale;
    for (const IntervalPoint& pu : intervalRule(uRule)) {
        for (const IntervalPoint& pv : intervalRule(vRule)) {
            const PatchPoint p =
                sampling.patch.at(cell.u0 + pu.position * du, cell.v0 + pv.position * dv);
            sampling.clip.append(p.position * lengthScale,
                                 (pu.weight * pv.weight * areaScale) * p.du.cross(p.dv),
                                 sampling.samples);
        }
    }
}

/// Of a cell that others may cut.
void applyTrimmedRule(const ParameterCell& cell, const PatchSampling& sampling) {
    const double lengthScale = 1.0 / sampling.voxelSize;
    for (const TrimmedPoint& t : sampling.trim->rule(sampling.patch, cell)) {
        const PatchPoint p = sampling.patch.at(t.u, t.v);
        sampling.clip.append(p.position * lengthScale,
                             (t.weight * lengthScale * lengthScale) * p.du.cross(p.dv),
                             sampling.samples);
    }
}

void sampleCell(const ParameterCell& cell, int depth, const PatchSampling& sampling) {
    // Leave out what the region cannot see; this changes no point that it can.
    const openvdb::BBoxd box = sampling.patch.bounds(cell);
    if (sampling.clip.misses(box.min() / sampling.voxelSize, box.max() / sampling.voxelSize)) {
        return;
    }

    // See what a union leaves of it.
    if (sampling.trim != nullptr) {
        const CellTrim::Share share = sampling.trim->share(sampling.patch, cell);
        if (share == CellTrim::Share::None) return;
        if (share == CellTrim::Share::All) {
            PatchSampling whole = sampling;
            whole.trim = nullptr;
            sampleCell(cell, depth, whole);
            return;
        }
    }

    const CellSize size = measure(cell, sampling);
    const bool isSmall = std::max(size.u, size.v) <= kCutCell || size.length <= kTinyCutCell;
    if (sampling.trim != nullptr && isSmall) {
        applyTrimmedRule(cell, sampling);
        return;
    }
    const int uRule = lowestIntervalRule(sampling.quadrature, size.u);
    const int vRule = lowestIntervalRule(sampling.quadrature, size.v);
    const bool isAccurate =
        sampling.trim == nullptr && uRule < kIntervalRules && vRule < kIntervalRules;
    if (isAccurate || depth == kDeepestCellSplit) {
        applyRules(std::min(uRule, kIntervalRules - 1), std::min(vRule, kIntervalRules - 1), cell,
                   sampling);
        return;
    }

    // Halve the longer side.
    ParameterCell first = cell;
    ParameterCell second = cell;
    if (size.u >= size.v) {
        first.u1 = second.u0 = 0.5 * (cell.u0 + cell.u1);
    } else {
        first.v1 = second.v0 = 0.5 * (cell.v0 + cell.v1);
    }
    sampleCell(first, depth + 1, sampling);
    sampleCell(second, depth + 1, sampling);
}

}  // namespace

void samplePatch(const Patch& patch, const CellTrim* trim, const SamplingRegion& region,
                 const SurfaceQuadrature& quadrature, std::vector<SurfaceSample>& samples) {
    sampleCell({}, 0, {patch, region.voxelSize, quadrature, RegionClip(region), samples, trim});
}

PatchSource::PatchSource(std::string name, PatchList patches, double volume, double area)
    : mName(std::move(name)), mPatches(std::move(patches)), mVolume(volume), mArea(area) {
    for (const auto& patch : mPatches) mBounds.expand(patch->bounds({}));
}

PatchSource::PatchSource(std::string name, PatchList patches, double volume, double area,
                         const openvdb::BBoxd& bounds)
    : mName(std::move(name)),
      mPatches(std::move(patches)),
      mBounds(bounds),
      mVolume(volume),
      mArea(area) {}

void PatchSource::sampleElement(std::size_t i, const SamplingRegion& region,
                                const SurfaceQuadrature& quadrature,
                                std::vector<SurfaceSample>& samples) const {
    requireUsefulLength(quadrature.cellSide.back(), "cell side");
    samplePatch(*mPatches[i], nullptr, region, quadrature, samples);
}

}  // namespace bandvox

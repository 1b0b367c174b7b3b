#pragma once

#include "outline/drawing/draw_curves.h"
#include "outline/drawing/visible_pieces.h"
#include "outline/drawn_view.h"
#include "outline/volumes/volume_drawing.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace bandvox::outline_test {

/// A field that is above 0 inside of a solid, by places in the world, as often as is asked for.
using InsideFunction = std::function<double(const openvdb::Vec3d&)>;
/// Makes such a function for one thread.
using InsideMaker = std::function<InsideFunction()>;

/// Lines of a view of volumes before they are fitted.
struct VolumeLines {
    std::unique_ptr<VolumeDrawing> drawing;
    DrawnView drawn;  // without patches
};

inline VolumeLines linesOf(const std::vector<OutlineVolume>& volumes,
                           const OutlineOptions& options) {
    VolumeLines lines;
    lines.drawing =
        std::make_unique<VolumeDrawing>(volumes, PatchModel{}, options, silentProgress());
    lines.drawn.size = std::max(options.width, options.height);
    lines.drawn.pixel = lines.drawn.size / 1000;
    lines.drawn.pieces = visiblePieces(lines.drawing->curves(), lines.drawing->scene(),
                                       samplingFor(options), silentProgress());
    return lines;
}

/// Whether a solid is before a point of a curve, by small steps towards the eye, voxels. The
/// surface that the point lies on is met, too: within half a voxel only what is above `rounding`
/// is inside.
inline bool isHidden(const VolumeSurface& surface, const CurvePoint& point,
                     const InsideFunction& inside, double rounding) {
    constexpr double kNear = 0.5, kStep = 0.03;
    const openvdb::FloatGrid& grid = surface.object->grid();
    const openvdb::Vec3d at(point.u, point.v, point.s);
    const openvdb::Vec3d start = surface.view.start(at, 3 * surface.size);
    const double length = (start - at).length();
    const openvdb::Vec3d back = (start - at) / length;
    const double last = std::min(length, 2 * surface.size);
    for (double t = kStep; t < last; t += kStep) {
        if (inside(grid.indexToWorld(at + t * back)) > (t < kNear ? rounding : 0)) return true;
    }
    return false;
}

/// Compares points of each piece, ten at least if it has them, with lines of sight in small steps;
/// what is within 0.2 pixels of a piece's ends, or of a cusp, is left out.
inline Findings checkVisibility(const VolumeLines& lines, const InsideMaker& inside,
                                double rounding) {
    const auto& pieces = lines.drawn.pieces;
    std::vector<Findings> found(pieces.size());
    parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t k) {
        const auto& [curve, hidden] = pieces[static_cast<std::size_t>(k)];
        Findings& result = found[static_cast<std::size_t>(k)];
        const InsideFunction field = inside();
        const auto& points = curve.points;
        const std::size_t every = std::max<std::size_t>(1, points.size() / 40);
        const double away = 0.2 * lines.drawn.pixel;
        for (std::size_t i = 0; i < points.size(); i += every) {
            const CurvePoint& p = points[i];
            const auto isNear = [&](const CurvePoint& q) {
                return std::hypot(p.x - q.x, p.y - q.y) < away;
            };
            if (!curve.closed && (isNear(points.front()) || isNear(points.back()))) continue;
            if (isNearCorner(lines.drawn, p, away)) continue;
            const auto& surface = lines.drawing->surfaces()[static_cast<std::size_t>(p.patch)];
            ++result.samples;
            if (isHidden(surface, p, field, rounding) == (hidden > 0)) continue;
            ++result.wrong;
            result.messages.push_back(describe(p, curve.kind) + "is hidden " +
                                      std::to_string(hidden) + " times, not by steps");
        }
    });
    Findings sum;
    for (const Findings& some : found) {
        sum.samples += some.samples;
        sum.wrong += some.wrong;
        sum.messages.insert(sum.messages.end(), some.messages.begin(), some.messages.end());
    }
    return sum;
}

/// Curves that are not closed.
inline int openCurves(const VolumeLines& lines) {
    int count = 0;
    for (const Curve& curve : lines.drawing->curves()) count += curve.closed ? 0 : 1;
    return count;
}

/// Places where images of curves turn back.
inline int cuspsOf(const VolumeLines& lines) {
    int count = 0;
    for (const Curve& curve : lines.drawing->curves()) {
        for (const CurvePoint& p : curve.points) count += p.corner ? 1 : 0;
    }
    return count;
}

}  // namespace bandvox::outline_test

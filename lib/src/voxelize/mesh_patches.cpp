#include "voxelize/mesh_patches.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {

namespace {

constexpr std::int64_t kChunk = 1 << 14;  // triangles to a task
constexpr int kStripWidth = 8;            // rows
constexpr int kSmallPatch = 64;           // rows that are not worth being split

using Corners = std::array<LatticePoint, 3>;

struct RowInterval {
    int begin, end;
};

RowInterval clipped(const RowInterval& a, int begin, int end) {
    return {std::max(a.begin, begin), std::min(a.end, end)};
}

// The rows whose samples lie within a triangle's extent along an axis.
RowInterval extent(const Corners& corners, int axis) {
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    return {ceilVoxel(low), ceilVoxel(high)};
}

// The rows that a triangle may meet, along the axis `across`, where they lie in `strip` along
// `along`: a triangle is convex, so its edges there bound it. In floating point, hence a row more
// on each side.
RowInterval reachInStrip(const Corners& corners, int along, int across, const RowInterval& strip) {
    const double low = double(strip.begin) * kVoxel, high = double(strip.end - 1) * kVoxel;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        LatticePoint p = corners[corner], q = corners[(corner + 1) % 3];
        if (p[along] > q[along]) std::swap(p, q);
        const double start = double(p[along]), end = double(q[along]);
        if (end < low || start > high) continue;
        const double slope = end > start ? double(q[across] - p[across]) / (end - start) : 0;
        const double enters = double(p[across]) + (start < low ? slope * (low - start) : 0.0);
        const double leaves =
            end > high ? double(p[across]) + slope * (high - start) : double(q[across]);
        least = std::min({least, enters, leaves});
        most = std::max({most, enters, leaves});
    }
    if (least > most) return {0, 0};
    return {static_cast<int>(std::floor(least / kVoxel)) - 1,
            static_cast<int>(std::ceil(most / kVoxel)) + 2};
}

class PatchMaker {
  public:
    PatchMaker(ScanAxis axis, const openvdb::CoordBBox& tile) : mAxis(axis), mTile(tile) {}

    void add(const Corners& corners, std::vector<MeshPatch>& patches) const {
        const RowInterval y = inTile(extent(corners, 1), 1), z = inTile(extent(corners, 2), 2);
        if (y.begin >= y.end || z.begin >= z.end) return;
        // A crossing is at most one voxel behind the triangle's extent.
        const RowInterval x = extent(corners, 0);
        if (x.end + 1 < mTile.min().x() || x.begin > mTile.max().x()) return;
        const int change = windingChange(corners);
        if (change == 0) return;

        const int height = y.end - y.begin, width = z.end - z.begin;
        if (std::int64_t(height) * width <= kSmallPatch) {
            return append(corners, change, y, z, patches);
        }
        // Cut it into strips across its longer side.
        const int along = height >= width ? 1 : 2;
        const RowInterval& length = along == 1 ? y : z;
        const RowInterval& breadth = along == 1 ? z : y;
        for (int begin = length.begin; begin < length.end; begin += kStripWidth) {
            const RowInterval strip{begin, std::min(begin + kStripWidth, length.end)};
            const RowInterval reach =
                clipped(reachInStrip(corners, along, 3 - along, strip), breadth.begin, breadth.end);
            if (reach.begin >= reach.end) continue;
            if (along == 1) {
                append(corners, change, strip, reach, patches);
            } else {
                append(corners, change, reach, strip, patches);
            }
        }
    }

  private:
    RowInterval inTile(const RowInterval& rows, int axis) const {
        return clipped(rows, mTile.min()[axis], mTile.max()[axis] + 1);
    }

    // Of a normal that points outward; 0 if no row crosses the triangle. The order of a scan along
    // y is a mirrored one. Coordinates take 31 bits, so their products take 62.
    int windingChange(const Corners& c) const {
        const std::int64_t normal =
            (c[1][1] - c[0][1]) * (c[2][2] - c[0][2]) - (c[1][2] - c[0][2]) * (c[2][1] - c[0][1]);
        if (normal == 0) return 0;
        return (normal < 0) == (mAxis != ScanAxis::Y) ? 1 : -1;
    }

    void append(const Corners& corners, int change, const RowInterval& y, const RowInterval& z,
                std::vector<MeshPatch>& patches) const {
        MeshPatch patch{};
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                patch.points[k][axis] = static_cast<std::int32_t>(corners[k][axis]);
            }
        }
        const auto pack = [](const RowInterval& rows, int first) {
            return static_cast<std::uint32_t>(rows.begin - first) |
                   static_cast<std::uint32_t>(rows.end - first) << 16;
        };
        patch.y = pack(y, mTile.min().y());
        patch.z = pack(z, mTile.min().z());
        patch.change = change;
        patches.push_back(patch);
    }

    ScanAxis mAxis;
    openvdb::CoordBBox mTile;
};

}  // namespace

std::vector<MeshPatch> patchesOf(const Mesh& mesh, const std::vector<LatticePoint>& points,
                                 ScanAxis axis, const openvdb::CoordBBox& tile) {
    const PatchMaker maker(axis, tile);
    const auto count = static_cast<std::int64_t>(mesh.triangles.size());
    std::vector<std::vector<MeshPatch>> chunks((count + kChunk - 1) / kChunk);
    parallelFor(static_cast<std::int64_t>(chunks.size()), [&](std::int64_t i) {
        const std::int64_t end = std::min(count, (i + 1) * kChunk);
        for (std::int64_t t = i * kChunk; t < end; ++t) {
            const openvdb::Vec3I& triangle = mesh.triangles[t];
            maker.add({points[triangle[0]], points[triangle[1]], points[triangle[2]]}, chunks[i]);
        }
    });
    std::size_t total = 0;
    for (const auto& chunk : chunks) total += chunk.size();
    requireMemory(static_cast<double>(total) * sizeof(MeshPatch), "the mesh for the GPU");
    std::vector<MeshPatch> patches;
    patches.reserve(total);
    for (auto& chunk : chunks) {
        patches.insert(patches.end(), chunk.begin(), chunk.end());
        chunk = {};
    }
    return patches;
}

}  // namespace bandvox

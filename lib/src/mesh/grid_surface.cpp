#include "core/words.h"
#include "mesh/cell_polygons.h"
#include "mesh/lattice_blocks.h"
#include "render/surface_field.h"
#include "source/compensated_sum.h"
#include "source/region_clip.h"
#include "source/triangle_sampling.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/grid_surface.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace bandvox {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::Vec3d;

namespace {

// Blocks that lie beside each other are one task.
constexpr int kSurfaceGroup = 64;
constexpr std::size_t kBlocksPerTask = 64;

// Rings have up to twelve corners.
constexpr int kMostCorners = 12;

/// An affine map of index coordinates.
struct IndexMap {
    Vec3d origin;
    std::array<Vec3d, 3> axes;

    Vec3d at(const Vec3d& index) const {
        return origin + index[0] * axes[0] + index[1] * axes[1] + index[2] * axes[2];
    }
};

/// The triangles of a block's cells, corners in its own index coordinates, counter-clockwise from
/// outside.
class BlockTriangles {
  public:
    explicit BlockTriangles(double iso) : mIso(iso) {}

    /// Calls visit(places, triangles) for each ring: its corners, and triples of their numbers.
    template <typename Visit>
    void forEachRing(const BlockValues& values, const Visit& visit) {
        findInside(values);
        for (int x = 0; x < kBlockSide; ++x) {
            for (int y = 0; y < kBlockSide; ++y) {
                const unsigned rows[] = {mInside[x][y], mInside[x + 1][y], mInside[x][y + 1],
                                         mInside[x + 1][y + 1]};
                const unsigned any = rows[0] | rows[1] | rows[2] | rows[3];
                const unsigned all = rows[0] & rows[1] & rows[2] & rows[3];
                // Cells whose corners are not all alike.
                unsigned crossed = (any | any >> 1) & ~(all & all >> 1) & kCellsOfRow;
                for (; crossed != 0; crossed &= crossed - 1) {
                    const int z = std::countr_zero(crossed);
                    unsigned inside = 0;
                    for (unsigned i = 0; i < 8; ++i) {
                        inside |= (rows[i & 3] >> (z + (i >> 2)) & 1U) << i;
                    }
                    visitCell(values, {x, y, z}, inside, visit);
                }
            }
        }
    }

  private:
    static constexpr unsigned kCellsOfRow = (1U << kBlockSide) - 1;

    // Of each row of nodes along z which are inside, one bit each.
    void findInside(const BlockValues& values) {
        for (int x = 0; x < kBlockNodes; ++x) {
            for (int y = 0; y < kBlockNodes; ++y) {
                unsigned row = 0;
                for (int z = 0; z < kBlockNodes; ++z) {
                    row |= (values.at(x, y, z) > mIso ? 1U : 0U) << z;
                }
                mInside[x][y] = row;
            }
        }
    }

    template <typename Visit>
    void visitCell(const BlockValues& values, const Coord& cell, unsigned inside,
                   const Visit& visit) {
        const unsigned ambiguous = facesToDecide(inside);
        const CellPolygons polygons =
            traceCell(inside, ambiguous == 0 ? 0 : joinedFaces(values, cell, ambiguous));
        const std::uint8_t* ring = polygons.edges.data();
        for (int r = 0; r < polygons.rings; ring += polygons.sizes[r++]) {
            std::size_t size = polygons.sizes[r];
            for (std::size_t k = 0; k < size; ++k) mPlaces[k] = crossing(values, cell, ring[k]);
            mTriangles.clear();
            if (!cutRing({ring, size}, {mPlaces.data(), size}, mTriangles)) {
                cutAroundCenter(size);
                ++size;
            }
            visit(std::span<const Vec3d>(mPlaces.data(), size), mTriangles);
        }
    }

    // Both cells at a face ask for the same sign.
    unsigned joinedFaces(const BlockValues& values, const Coord& cell, unsigned ambiguous) const {
        unsigned joined = 0;
        for (int face = 0; face < 6; ++face) {
            if ((ambiguous >> face & 1) == 0) continue;
            const int axis = face / 2;
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            const auto above = [&](int du, int dv) {
                Coord node = cell;
                node[axis] += face % 2;
                node[u] += du;
                node[v] += dv;
                return values.at(node[0], node[1], node[2]) - mIso;
            };
            // The bilinear function's value where its slope is 0 has the sign of this, as the
            // inside lies on the diagonal of the corners that are positive.
            const double straight = above(0, 0) * above(1, 1);
            const double across = above(1, 0) * above(0, 1);
            const bool isStraightInside = above(0, 0) > 0;
            if (isStraightInside ? straight > across : across > straight) joined |= 1U << face;
        }
        return joined;
    }

    Vec3d crossing(const BlockValues& values, const Coord& cell, int edge) const {
        const int corner = lowerCorner(edge);
        Coord node(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2));
        Vec3d place = node.asVec3d();
        const double low = values.at(node[0], node[1], node[2]) - mIso;
        ++node[edge / 4];
        const double high = values.at(node[0], node[1], node[2]) - mIso;
        place[edge / 4] += low / (low - high);
        return place;
    }

    void cutAroundCenter(std::size_t size) {
        Vec3d sum(0.0);
        for (std::size_t k = 0; k < size; ++k) sum += mPlaces[k];
        mPlaces[size] = sum / double(size);
        for (std::size_t k = 0; k < size; ++k) mTriangles.emplace_back(k, (k + 1) % size, size);
    }

    double mIso;
    std::array<std::array<unsigned, kBlockNodes>, kBlockNodes> mInside{};
    std::array<Vec3d, kMostCorners + 1> mPlaces;
    std::vector<openvdb::Vec3I> mTriangles;
};

class GridSurface final : public BoundarySource {
  public:
    GridSurface(std::string name, const openvdb::FloatGrid::ConstPtr& grid,
                const GridSurfaceOptions& options, Progress& progress);

    std::string name() const override { return mName; }
    BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mBlocks.size(); }
    BBoxd elementBounds(std::size_t i) const override;
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    /// What the blocks of a task add up to.
    struct Part {
        std::vector<Coord> blocks;
        BBoxd bounds;
        CompensatedSum volume, area;
    };

    void measure(Progress& progress);
    void measureBlock(const Coord& origin, BlockTriangles& triangles, const BlockValues& values,
                      Part& part) const;
    IndexMap mapOf(const Coord& origin, double voxelSize) const;

    std::string mName;
    openvdb::FloatGrid::ConstPtr mGrid;
    double mIso;
    IndexMap mMap;  // to the source's world
    double mTurn;   // -1 where the map mirrors
    Vec3d mMiddle;  // of the grid; about it volumes cancel little
    std::vector<Coord> mBlocks;
    BBoxd mBounds;
    double mVolume = 0, mArea = 0;
};

GridSurface::GridSurface(std::string name, const openvdb::FloatGrid::ConstPtr& grid,
                         const GridSurfaceOptions& options, Progress& progress)
    : mName(std::move(name)) {
    const DrawableGrid drawable = makeDrawable(grid, options.iso);
    mGrid = drawable.grid;
    mIso = drawable.iso;
    const auto place = [&](const Vec3d& index) {
        return options.toSource.transform(grid->indexToWorld(index));
    };
    mMap.origin = place(Vec3d(0.0));
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d unit(0.0);
        unit[axis] = 1;
        mMap.axes[axis] = place(unit) - mMap.origin;
    }
    const double volume = mMap.axes[0].cross(mMap.axes[1]).dot(mMap.axes[2]);
    mTurn = volume < 0 ? -1 : 1;
    mMiddle = mMap.at(mGrid->evalActiveVoxelBoundingBox().getCenter());
    measure(progress);
    if (mBlocks.empty()) {
        float highest = mGrid->background();
        for (auto value = mGrid->cbeginValueOn(); value; ++value) {
            highest = std::max(highest, *value);
        }
        const double sign = drawable.isLevelSet ? -1 : 1;
        std::string message = mName + ": the solid is empty: values are at ";
        message += drawable.isLevelSet ? "least " : "most ";
        message += inShort(sign * highest) + ", and the surface is where they are ";
        message += inShort(sign * mIso);
        throw Error(ErrorKind::Result, message);
    }
}

void GridSurface::measure(Progress& progress) {
    const std::vector<Coord> candidates = candidateBlocks(*mGrid, mIso, kSurfaceGroup);
    const std::size_t tasks = (candidates.size() + kBlocksPerTask - 1) / kBlocksPerTask;
    std::vector<Part> parts(tasks);
    const ProgressStage stage(progress, "finding the surface", static_cast<std::int64_t>(tasks));
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kBlocksPerTask;
        const std::size_t end = std::min(begin + kBlocksPerTask, candidates.size());
        BlockTriangles triangles(mIso);
        BlockValues values;
        for (std::size_t i = begin; i < end; ++i) {
            values.read(*mGrid, candidates[i]);
            if (!values.crosses(mIso)) continue;
            parts[task].blocks.push_back(candidates[i]);
            measureBlock(candidates[i], triangles, values, parts[task]);
        }
        progress.advance();
    });
    CompensatedSum volume, area;
    for (const Part& part : parts) {
        mBlocks.insert(mBlocks.end(), part.blocks.begin(), part.blocks.end());
        if (!part.blocks.empty()) mBounds.expand(part.bounds);
        volume.add(part.volume.value());
        area.add(part.area.value());
    }
    mVolume = volume.value();
    mArea = area.value();
}

void GridSurface::measureBlock(const Coord& origin, BlockTriangles& triangles,
                               const BlockValues& values, Part& part) const {
    const IndexMap map = mapOf(origin, 1);
    triangles.forEachRing(
        values, [&](std::span<const Vec3d> places, const std::vector<openvdb::Vec3I>& numbers) {
            for (const openvdb::Vec3I& t : numbers) {
                const Vec3d a = map.at(places[t[0]]);
                const Vec3d b = map.at(places[t[1]]);
                const Vec3d c = map.at(places[t[2]]);
                const Vec3d normal = mTurn * (b - a).cross(c - a);
                part.volume.add((a - mMiddle).dot(normal) / 6.0);
                part.area.add(0.5 * normal.length());
                part.bounds.expand(a);
                part.bounds.expand(b);
                part.bounds.expand(c);
            }
        });
}

IndexMap GridSurface::mapOf(const Coord& origin, double voxelSize) const {
    IndexMap map = mMap;
    map.origin = mMap.at(origin.asVec3d()) / voxelSize;
    for (Vec3d& axis : map.axes) axis /= voxelSize;
    return map;
}

BBoxd GridSurface::elementBounds(std::size_t i) const {
    const IndexMap map = mapOf(mBlocks[i], 1);
    BBoxd box;
    for (int k = 0; k < 8; ++k) {
        box.expand(map.at({(k & 1) != 0 ? kBlockSide : 0.0, (k & 2) != 0 ? kBlockSide : 0.0,
                           (k & 4) != 0 ? kBlockSide : 0.0}));
    }
    return box;
}

void GridSurface::sampleElement(std::size_t i, const SamplingRegion& region,
                                const SurfaceQuadrature& quadrature,
                                std::vector<SurfaceSample>& samples) const {
    requireUsefulLength(quadrature.triangleEdge.back(), "triangle edge");
    // As with triangles, rounding is that of places relative to a whole voxel at the block.
    IndexMap map = mapOf(mBlocks[i], region.voxelSize);
    const Vec3d base(std::floor(map.origin[0]), std::floor(map.origin[1]),
                     std::floor(map.origin[2]));
    map.origin -= base;
    const RegionClip clip({region.voxelSize, region.origin - base, region.extent});
    BlockValues values;
    values.read(*mGrid, mBlocks[i]);
    BlockTriangles(mIso).forEachRing(
        values, [&](std::span<const Vec3d> places, const std::vector<openvdb::Vec3I>& numbers) {
            std::array<Vec3d, kMostCorners + 1> corners;
            Vec3d low(map.at(places[0]));
            Vec3d high = low;
            for (std::size_t k = 0; k < places.size(); ++k) {
                corners[k] = map.at(places[k]);
                low = openvdb::math::minComponent(low, corners[k]);
                high = openvdb::math::maxComponent(high, corners[k]);
            }
            if (clip.misses(low, high)) return;
            for (const openvdb::Vec3I& t : numbers) {
                const std::array<Vec3d, 3> corner{corners[t[0]], corners[t[1]], corners[t[2]]};
                const Vec3d areaVector =
                    0.5 * mTurn * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
                if (areaVector.lengthSqr() == 0.0) continue;
                sampleTriangle(corner, quadrature, clip, [&](const TriangleCell<Vec3d>& cell) {
                    const Vec3d e1 = cell.corner[1] - cell.corner[0];
                    const Vec3d e2 = cell.corner[2] - cell.corner[0];
                    for (const TrianglePoint& p : cell.rule) {
                        clip.append(cell.corner[0] + p.b * e1 + p.c * e2,
                                    p.weight * cell.share * areaVector, samples);
                    }
                });
            }
        });
}

}  // namespace

std::unique_ptr<BoundarySource> makeGridSurface(const std::string& name,
                                                const openvdb::FloatGrid::ConstPtr& grid,
                                                const GridSurfaceOptions& options,
                                                Progress& progress) {
    if (!grid) throw Error(ErrorKind::Usage, "a surface needs a grid, but got none");
    if (options.toSource.getMat3().det() == 0) {
        throw Error(ErrorKind::Usage,
                    "the map to the surface's world is flat; expected one that "
                    "can be undone");
    }
    return std::make_unique<GridSurface>(name, grid, options, progress);
}

}  // namespace bandvox

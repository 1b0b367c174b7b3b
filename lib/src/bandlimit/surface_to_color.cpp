#include "bandlimit/color_column.h"
#include "bandlimit/density_steps.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/surface_quadrature.h"
#include "core/words.h"
#include "core/worker_pool.h"

#include <bandvox/bandlimit/surface_to_color.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/join_shards.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bandvox {

namespace {

using std::numbers::pi;

// The part of a flat face's h * δ_S above which a colour is active. Cubic interpolation on a face
// needs voxels up to 2 √3 away from it, where the default filter has left a twentieth.
constexpr double kLeastShare = 1e-2;

// Errors of h * δ_S that are allowed, as a part of a flat face's: by halo, kernel and the like
// they count a hundred times where the colour is active but far; by the quadrature they do not,
// since a Gaussian weakens them with the distance as it does the rest.
constexpr double kMeasureTolerance = 1e-5;
constexpr double kQuadratureTolerance = 1e-4;

// The highest cutoff of a Gaussian that the lattice holds (see docs/math/exact-route.md).
constexpr double kHighestCutoff = 0.16;

// h * δ_S on a flat face, per voxel: ∫ exp(-(k/k_c)²) dk.
double areaOnFace(const ExponentialFilter& filter) {
    return std::sqrt(pi) * filter.cutoff;
}

// How far from a flat face colours are active, voxels.
double reachOf(const ExponentialFilter& filter) {
    return std::sqrt(-std::log(kLeastShare)) / (pi * filter.cutoff);
}

TilePlan makeColorPlan(const ColorOptions& options) {
    DensityOptions density;
    density.filter = colorFilter(options.filter);
    density.voxelSize = options.voxelSize;
    density.tolerance = kMeasureTolerance;
    density.tile = options.tile;
    requireValid(density);
    TilePlan plan = makeTilePlan(density);
    plan.quadrature = chooseQuadrature(plan.filter, kQuadratureTolerance);
    return plan;
}

struct PaintedSurface {
    std::vector<std::uint32_t> triangles;
    openvdb::BBoxd bounds;  // world units
    double area = 0;        // world units²
};

PaintedSurface paintedSurface(const ColoredMesh& mesh) {
    PaintedSurface surface;
    for (std::size_t i = 0; i < mesh.paints.size(); ++i) {
        if (mesh.paints[i].texture == TrianglePaint::kNoColor) continue;
        const openvdb::Vec3I& t = mesh.mesh.triangles[i];
        const openvdb::Vec3d& a = mesh.mesh.points[t[0]];
        const openvdb::Vec3d& b = mesh.mesh.points[t[1]];
        const openvdb::Vec3d& c = mesh.mesh.points[t[2]];
        for (const openvdb::Vec3d& p : {a, b, c}) surface.bounds.expand(p);
        surface.area += 0.5 * (b - a).cross(c - a).length();
        surface.triangles.push_back(static_cast<std::uint32_t>(i));
    }
    if (!(surface.area > 0)) {
        throw Error(ErrorKind::Result, mesh.name +
                                           ": no triangle has both a colour and an area; the grid "
                                           "of colours would be empty");
    }
    return surface;
}

// Bytes for the grid, and for the work on it.
double estimateMemory(const PaintedSurface& surface, const TilePlan& plan, const TileLayout& layout,
                      const TileFilter& filter) {
    const double area = surface.area / (layout.voxelSize * layout.voxelSize);
    const double thickness = 2 * reachOf(plan.filter) + ColorLeaf::DIM;
    constexpr double kPieces = 2;  // blocks at the columns' borders exist in pieces first
    const double grid = kPieces * sizeof(ColorLeaf) * area * thickness / ColorLeaf::SIZE +
                        kPieces * sizeof(openvdb::Vec3f) * area * thickness;

    // A tile holds about three times its own cross-section, and of the triangles that much; of a
    // texture a voxel's face takes some forty points, and a vector grows to twice what it holds.
    const auto triangles = static_cast<double>(surface.triangles.size());
    const double crossSection = static_cast<double>(plan.side) * plan.side;
    const double samples = 3 * std::max(40 * crossSection, triangles * crossSection / area);
    const double perThread = ColorColumn::memory(plan, filter) +
                             2 * (sizeof(ColoredSample) + sizeof(PairedSample)) * samples;
    const double tilesOfTriangle = 1 + 2.0 * (plan.halo + 1) / plan.interior;
    const double bins = sizeof(std::uint32_t) * triangles * tilesOfTriangle * tilesOfTriangle;
    return grid + bins + memoryOfColumns(layout) + threadCount() * perThread;
}

std::vector<ColorBlocks> fillColorColumns(const ColoredMesh& mesh, const PaintedSurface& surface,
                                          const TilePlan& plan, const TileLayout& layout,
                                          const TileFilter& filter, const Shard& shard,
                                          Progress& progress) {
    const auto boundsOf = [&](std::size_t i) {
        openvdb::BBoxd box;
        const openvdb::Vec3I& t = mesh.mesh.triangles[surface.triangles[i]];
        for (int k = 0; k < 3; ++k) box.expand(mesh.mesh.points[t[k]]);
        return box;
    };
    const ElementBins bins(surface.triangles.size(), boundsOf, layout, plan.halo);
    const auto leastArea = static_cast<float>(kLeastShare * areaOnFace(plan.filter));
    WorkerPool<ColorColumn> pool(
        [&] { return std::make_unique<ColorColumn>(mesh, plan, layout, filter, leastArea); });
    const std::int64_t count = static_cast<std::int64_t>(layout.count.y()) * layout.count.z();
    std::vector<ColorBlocks> columns(count);
    const ProgressStage stage(progress, "colouring", count);
    parallelFor(count, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        if (!shard.holds(i)) return progress.advance();
        const int y = static_cast<int>(i / layout.count.z());
        const int z = static_cast<int>(i % layout.count.z());
        std::vector<std::uint32_t> triangles;
        for (const std::uint32_t p : bins.column(y, z)) triangles.push_back(surface.triangles[p]);
        if (!triangles.empty()) {
            std::unique_ptr<ColorColumn> worker = pool.take();
            columns[i] = worker->fill(y, z, triangles, progress);
            pool.giveBack(std::move(worker));
        }
        progress.advance();
    });
    return columns;
}

// Joins the columns: of the pieces of a block each has the voxels of its own column.
openvdb::Vec3SGrid::Ptr joinColumns(std::vector<ColorBlocks>& columns, double voxelSize) {
    std::vector<std::unique_ptr<ColorLeaf>> leaves;
    for (ColorBlocks& column : columns) {
        std::move(column.leaves.begin(), column.leaves.end(), std::back_inserter(leaves));
        column.leaves.clear();
    }
    std::sort(leaves.begin(), leaves.end(),
              [](const auto& a, const auto& b) { return a->origin() < b->origin(); });
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    for (std::size_t i = 0; i < leaves.size();) {
        std::unique_ptr<ColorLeaf> leaf = std::move(leaves[i]);
        for (++i; i < leaves.size() && leaves[i]->origin() == leaf->origin(); ++i) {
            for (auto value = leaves[i]->cbeginValueOn(); value; ++value) {
                leaf->setValueOn(value.pos(), *value);
            }
            leaves[i].reset();
        }
        grid->tree().addLeaf(leaf.release());
    }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    return grid;
}

}  // namespace

ExponentialFilter colorFilter(const ExponentialFilter& density) {
    // exp(-(k/k_c)^n) = 1/2 where k = k_c (ln 2)^{1/n}.
    const double cutoff = density.cutoff * std::pow(std::numbers::ln2, 1 / density.order - 1.0 / 2);
    return {2, std::min(cutoff, kHighestCutoff)};
}

ColorResult surfaceToColor(const ColoredMesh& mesh, const ColorOptions& options,
                           Progress& progress) {
    // Decide how the work is cut up, and whether it fits.
    requireValid(options.filter);
    requireValid(options.shard);
    if (!(options.voxelSize > 0)) {
        throw Error(ErrorKind::Usage, "the voxel size is " + inShort(options.voxelSize) +
                                          "; it must be positive, in world units");
    }
    const PaintedSurface surface = paintedSurface(mesh);
    const TilePlan plan = makeColorPlan(options);
    const TileLayout layout = layOutTiles(surface.bounds, options.voxelSize, plan);
    const TileFilter filter(plan, TileFilter::Output::Values);
    const std::string wanted =
        "a grid of colours in voxels of " + inShort(options.voxelSize) + " world units";
    requireMemory(estimateMemory(surface, plan, layout, filter), wanted.c_str());

    std::vector<ColorBlocks> columns =
        fillColorColumns(mesh, surface, plan, layout, filter, options.shard, progress);
    ColorResult result;
    for (const ColorBlocks& column : columns) {
        result.tiles += column.tiles;
        result.surfaceSamples += column.samples;
    }
    result.grid = joinColumns(columns, options.voxelSize);
    progress.throwIfInterrupted();
    if (result.grid->tree().empty() && options.shard.isWhole()) {
        throw Error(ErrorKind::Result, mesh.name +
                                           ": the coloured surface is too small for any voxel; the "
                                           "grid of colours would be empty");
    }
    result.grid->setName("Cd");
    result.grid->setVectorType(openvdb::VEC_INVARIANT);
    result.grid->setCreator(std::string("bandvox ") + version());
    setSourceMetadata(*result.grid, mesh.name);
    setShardMetadata(*result.grid, {options.shard, false, 0});
    return result;
}

}  // namespace bandvox

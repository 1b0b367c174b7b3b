#include "render/surface_field.h"

#include "reconstruct/interpolation_design.h"
#include "render/examine_leaves.h"
#include "render/picture_request.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

using FieldTree = openvdb::FloatTree;
using FieldLeaf = FieldTree::LeafNodeType;

// Of solids under a filter that does not ring a flat face is the steepest; others come close.
constexpr double kSteepestMargin = 1.5;

// By how much a spline may be steeper along an axis than what it goes through: between two nodes
// of a single step it is 1.27 times as steep. Distances change alike in all directions.
constexpr double kSplineMargin = 1.35;
const double kSplineSteepest = kSplineMargin * std::sqrt(3.0);

// The same grid with opposite signs.
openvdb::FloatGrid::Ptr opposite(const openvdb::FloatGrid& grid) {
    openvdb::FloatGrid::Ptr copy = grid.deepCopy();
    FieldTree& tree = copy->tree();
    tree.root().setBackground(-grid.background(), false);
    auto tile = tree.beginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(-*tile);
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        float* values = leaf->buffer().data();
        for (openvdb::Index i = 0; i < FieldLeaf::SIZE; ++i) values[i] = -values[i];
    }
    copy->setGridClass(openvdb::GRID_FOG_VOLUME);
    return copy;
}

// The largest difference between neighbours along an axis.
double largestStep(const openvdb::FloatGrid& grid, const Progress& progress) {
    std::vector<const FieldLeaf*> leaves;
    grid.tree().getNodes(leaves);
    const auto largestIn = [&grid](const FieldLeaf& leaf) {
        double largest = 0;
        const auto accessor = grid.getConstAccessor();
        const float* values = leaf.buffer().data();
        const auto compare = [&](const openvdb::Coord& at, float value) {
            largest = std::max(largest, std::abs(double(accessor.getValue(at)) - value));
        };
        for (openvdb::Index i = 0; i < FieldLeaf::SIZE; ++i) {
            const openvdb::Coord local = FieldLeaf::offsetToLocalCoord(i);
            const openvdb::Index stride[] = {64, 8, 1};
            for (int axis = 0; axis < 3; ++axis) {
                openvdb::Coord next = leaf.origin() + local;
                if (local[axis] + 1 < static_cast<int>(FieldLeaf::DIM)) {
                    largest =
                        std::max(largest, std::abs(double(values[i + stride[axis]]) - values[i]));
                } else {
                    ++next[axis];
                    compare(next, values[i]);
                }
                if (local[axis] == 0) {
                    next = leaf.origin() + local;
                    --next[axis];
                    compare(next, values[i]);
                }
            }
        }
        return largest;
    };
    const std::vector<double> found = examineLeaves(leaves, progress, largestIn);
    double largest = 0;
    for (const double step : found) largest = std::max(largest, step);
    // Beside a tile may lie another one.
    const auto accessor = grid.getConstAccessor();
    auto tile = grid.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        progress.throwIfInterrupted();
        const openvdb::CoordBBox box = tile.getBoundingBox();
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Coord before = box.min(), after = box.min();
            --before[axis];
            after[axis] = box.max()[axis] + 1;
            for (const openvdb::Coord& at : {before, after}) {
                largest = std::max(largest, std::abs(double(accessor.getValue(at)) - *tile));
            }
        }
    }
    return largest;
}

// What the density of a grid of this library may be off by.
double densityError(const DensityMetadata& metadata) {
    constexpr double kOfSampling = 0.05;  // where it was not measured
    const double ofSampling =
        std::isnan(metadata.samplingError) ? kOfSampling : metadata.samplingError;
    return std::max(ClearDistance::kDensityError,
                    metadata.tolerance + ofSampling + metadata.storageError);
}

// How far lines of sight may step in a band-limited density, outside and inside. Solids under the
// default filter have a sharp bound; others are taken to be about as steep as a flat face.
std::pair<ClearDistance, ClearDistance> clearDistances(const DrawableGrid& drawable, double maximum,
                                                       double faceSlope) {
    constexpr double kRounding = 1e-2;
    const DensityMetadata& metadata = *drawable.metadata;
    const double background = drawable.grid->background(), iso = drawable.iso;
    const double error = densityError(metadata);
    // Overlapping shells that were limited to 1 are no solid's density.
    if (metadata.order == 2 && !metadata.clamped && background == 0 && maximum < 1 + kRounding &&
        iso < 1) {
        // What is outside of a solid is a solid, too.
        return {ClearDistance::ofGaussian(iso, metadata.cutoff, error),
                ClearDistance::ofGaussian(1 - iso, metadata.cutoff, error + kRounding)};
    }
    const double steepest = kSteepestMargin * faceSlope * std::max(1.0, maximum - background);
    return {ClearDistance::ofSlope(iso, background, steepest, error),
            ClearDistance::ofSlope(std::max(maximum, iso + error), iso, steepest, error)};
}

// Sharp filters keep more than can be read between the nodes to a fine tolerance: then read them as
// well as can be.
std::unique_ptr<Reconstruction> readFiltered(const openvdb::FloatGrid::ConstPtr& grid,
                                             BrickReconstructionOptions options) {
    constexpr double kCoarsestTolerance = 0.1;
    for (;; options.tolerance *= 3) {
        try {
            options.tolerance = std::min(options.tolerance, kCoarsestTolerance);
            return makeBrickReconstruction(grid, options);
        } catch (const Error& error) {
            if (options.tolerance < kCoarsestTolerance) continue;
            throw Error(ErrorKind::Input,
                        "the grid \"" + grid->getName() + "\" cannot be read: " + error.what());
        }
    }
}

}  // namespace

std::size_t cacheBytes(const PictureOptions& options) {
    if (options.cacheBytes > 0) return options.cacheBytes;
    constexpr std::int64_t kLeast = std::int64_t(64) << 20, kMost = std::int64_t(2) << 30;
    return static_cast<std::size_t>(std::clamp(availableMemory() / 4, kLeast, kMost));
}

DrawableGrid makeDrawable(const openvdb::FloatGrid::ConstPtr& grid,
                          const std::optional<double>& iso) {
    requireDrawable(*grid);
    DrawableGrid drawable{grid, densityMetadata(*grid)};
    drawable.isLevelSet = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
    if (!drawable.isLevelSet) {
        drawable.iso = isoOf(*grid, drawable.metadata, iso);
        return drawable;
    }
    // Distances are negative inside.
    drawable.metadata.reset();
    const double distance = iso.value_or(0);
    if (!isAboveBackground(-distance, -grid->background())) {
        std::ostringstream message;
        message << "the iso-value is " << distance
                << "; it must be below the level set's background, " << grid->background();
        throw Error(iso ? ErrorKind::Usage : ErrorKind::Input, message.str());
    }
    drawable.grid = opposite(*grid);
    drawable.iso = -distance;
    return drawable;
}

std::unique_ptr<Reconstruction> readLattice(const openvdb::FloatGrid::ConstPtr& grid,
                                            const std::optional<DensityMetadata>& metadata,
                                            const PictureOptions& options,
                                            const std::optional<DensityBand>& mostlyRead) {
    if (!metadata) return makeSplineReconstruction(grid, cacheBytes(options), mostlyRead);
    const double tolerance =
        options.readsFinely ? options.tolerance : std::max(metadata->tolerance, options.tolerance);
    return readFiltered(
        grid, {{metadata->order, metadata->cutoff}, tolerance, cacheBytes(options), mostlyRead});
}

SurfaceField readSurface(const DrawableGrid& drawable, double maximum,
                         const PictureOptions& options, const Progress& progress) {
    const auto field = [&](double slope, const ClearDistance& outside,
                           const ClearDistance& inside) -> SurfaceField {
        const DensityBand asked = askedBand(drawable.iso, outside, inside);
        return {readLattice(drawable.grid, drawable.metadata, options, asked), slope, outside,
                inside};
    };
    const double iso = drawable.iso;
    if (drawable.metadata) {
        const double slope = faceGradient({drawable.metadata->order, drawable.metadata->cutoff});
        const auto [outside, inside] = clearDistances(drawable, maximum, slope);
        return field(slope, outside, inside);
    }
    const double step = largestStep(*drawable.grid, progress);
    const double steepest = (drawable.isLevelSet ? kSplineMargin : kSplineSteepest) * step;
    return field(step, ClearDistance::ofSlope(iso, drawable.grid->background(), steepest, 0),
                 ClearDistance::ofSlope(std::max(maximum, iso + step), iso, steepest, 0));
}

double surfaceThreshold(const DrawableGrid& drawable) {
    // A Gaussian rises above the nodes by no more than its slope times half a voxel's diagonal,
    // 0.24, and others not much further; half the height is on the safe side.
    return 0.5 * (drawable.iso + drawable.grid->background());
}

}  // namespace bandvox

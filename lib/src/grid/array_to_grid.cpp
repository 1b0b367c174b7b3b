#include "grid/array_lattice.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_box.h>
#include <bandvox/grid/array_to_grid.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace bandvox {

namespace {

using ArrayLeaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSlab = ArrayLeaf::DIM;

// Eight slices of an array, the first of which has this number.
struct Slab {
    const ArrayInfo& info;
    int first;
    int slices;
    const std::vector<float>& values;

    // The values at (fast, middle, slice) of the file's axes.
    const float* row(int middle, int slice) const {
        return &values[(static_cast<std::size_t>(slice) * info.size[info.axes[1]] + middle) *
                       info.size[info.axes[0]]];
    }
};

// What becomes of 8³ voxels.
struct LeafOrTile {
    std::unique_ptr<ArrayLeaf> leaf;
    openvdb::Coord origin;
    bool isTile = false;
    float value = 0;
    bool finite = true;
};

// The block whose first voxel along the file's axes is (fast, middle) of a slab.
LeafOrTile makeLeaf(const Slab& slab, int fast, int middle, const ArrayGridOptions& options) {
    const ArrayInfo& info = slab.info;
    LeafOrTile result;
    result.origin[info.axes[0]] = fast;
    result.origin[info.axes[1]] = middle;
    result.origin[info.axes[2]] = slab.first;
    auto leaf = std::make_unique<ArrayLeaf>(result.origin, options.background);
    float* to = leaf->buffer().data();
    // Offsets are x, y, z, three bits each.
    const int shifts[] = {6, 3, 0};
    const int fastShift = shifts[info.axes[0]], middleShift = shifts[info.axes[1]],
              sliceShift = shifts[info.axes[2]];
    const int fasts = std::min(kSlab, info.size[info.axes[0]] - fast);
    const int middles = std::min(kSlab, info.size[info.axes[1]] - middle);
    ArrayLeaf::NodeMaskType active;
    for (int s = 0; s < slab.slices; ++s) {
        for (int m = 0; m < middles; ++m) {
            const float* row = slab.row(middle + m, s) + fast;
            for (int f = 0; f < fasts; ++f) {
                result.finite = result.finite && std::isfinite(row[f]);
                if (std::abs(row[f] - options.background) <= options.tolerance) continue;
                const int offset = s << sliceShift | m << middleShift | f << fastShift;
                to[offset] = row[f];
                active.setOn(offset);
            }
        }
    }
    if (active.isOff()) return result;
    const bool isConstant = active.isOn() && std::all_of(to, to + ArrayLeaf::SIZE,
                                                         [to](float v) { return v == to[0]; });
    if (isConstant) {
        result.isTile = true;
        result.value = to[0];
        return result;
    }
    leaf->setValueMask(active);
    result.leaf = std::move(leaf);
    return result;
}

void addSlab(const Slab& slab, const ArrayGridOptions& options, openvdb::FloatTree& tree) {
    const ArrayInfo& info = slab.info;
    const int across = (info.size[info.axes[0]] + kSlab - 1) / kSlab;
    const int down = (info.size[info.axes[1]] + kSlab - 1) / kSlab;
    std::vector<LeafOrTile> made(static_cast<std::size_t>(across) * down);
    parallelFor(down, [&](std::int64_t row) {
        for (int column = 0; column < across; ++column) {
            made[static_cast<std::size_t>(row) * across + column] =
                makeLeaf(slab, column * kSlab, static_cast<int>(row) * kSlab, options);
        }
    });
    for (LeafOrTile& block : made) {
        if (!block.finite) {
            throw Error(ErrorKind::Input,
                        info.name + ": there is a value that is not finite near voxel (" +
                            std::to_string(block.origin[0]) + ", " +
                            std::to_string(block.origin[1]) + ", " +
                            std::to_string(block.origin[2]) + "); expected numbers");
        }
        if (block.isTile) tree.addTile(1, block.origin, block.value, true);
        if (block.leaf) tree.addLeaf(block.leaf.release());
    }
}

}  // namespace

openvdb::FloatGrid::Ptr arrayToGrid(ArraySource& source, const ArrayGridOptions& options,
                                    Progress& progress) {
    const ArrayInfo& info = source.info();
    const openvdb::math::Transform::Ptr lattice = latticeOf(info);
    if (!std::isfinite(options.background) || !(options.tolerance >= 0)) {
        throw Error(ErrorKind::Usage,
                    "the background is a number, and what is as near to it is not below 0");
    }
    const double slabBytes = double(info.valuesPerSlice()) * kSlab * sizeof(float);
    requireMemory(2 * slabBytes, "eight slices of the array");

    auto grid = openvdb::FloatGrid::create(options.background);
    std::vector<float> values;
    const ProgressStage stage(progress, "reading", (info.slices() + kSlab - 1) / kSlab);
    for (int first = 0; first < info.slices(); first += kSlab) {
        progress.throwIfInterrupted();
        // A slab may become as large as itself.
        requireMemory(2 * slabBytes, "the grid, as far as it has been read,");
        const int slices = std::min(kSlab, info.slices() - first);
        values.resize(static_cast<std::size_t>(info.valuesPerSlice()) * slices);
        source.readSlices(values);
        addSlab({info, first, slices, values}, options, grid->tree());
        progress.advance();
    }
    openvdb::tools::pruneTiles(grid->tree(), 0.0F, /*threaded=*/false);
    grid->setTransform(lattice);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    setSourceMetadata(*grid, std::filesystem::path(info.name).filename().string());
    setArrayBox(*grid, {openvdb::Coord(0), info.size.offsetBy(-1)});
    setPlaceMetadata(*grid, {info.unit, info.space});
    return grid;
}

}  // namespace bandvox

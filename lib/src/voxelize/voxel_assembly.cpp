#include "voxelize/voxel_assembly.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace bandvox {

namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;

// A cell is what a node of leaf nodes covers, 16³ of them. Its level as a tile is 2, a leaf
// node's is 1.
constexpr int kCellLog2 = 4;
constexpr int kCellSide = 1 << kCellLog2;
static_assert(Tree::RootNodeType::ChildNodeType::ChildNodeType::LOG2DIM == kCellLog2);

// Columns [begin, end) along y and z that pass through the same cells.
struct ColumnGroup {
    Coord begin, end;  // leaf nodes, voxel / 8; x does not matter
};

std::vector<ColumnGroup> groupColumns(const VoxelLattice& lattice) {
    const Coord first = lattice.firstBlock, end = first + lattice.blockCount;
    const auto start = [](int i) { return (i >> kCellLog2) << kCellLog2; };
    std::vector<ColumnGroup> groups;
    for (int y = start(first.y()); y < end.y(); y += kCellSide) {
        for (int z = start(first.z()); z < end.z(); z += kCellSide) {
            groups.push_back({Coord::maxComponent(Coord(0, y, z), Coord(0, first.y(), first.z())),
                              Coord::minComponent(Coord(0, y + kCellSide, z + kCellSide),
                                                  Coord(0, end.y(), end.z()))});
        }
    }
    return groups;
}

// Makes active tiles of what is solid in a group, as large as can be.
class SolidTiles {
  public:
    SolidTiles(Tree& tree, const VoxelLattice& lattice) : mTree(tree), mLattice(lattice) {}

    // Looks at a run before any is added.
    void count(const SolidRun& run) {
        for (int cell = (run.begin + kCellSide - 1) >> kCellLog2;
             (cell + 1) << kCellLog2 <= run.end; ++cell) {
            ++mColumns[cell];
        }
    }

    void add(Coord block, const SolidRun& run) {
        for (block.x() = run.begin; block.x() < run.end; ++block.x()) {
            const auto columns = mColumns.find(block.x() >> kCellLog2);
            if (columns == mColumns.end() || columns->second < kCellSide * kCellSide) {
                addTile(1, block);
                continue;
            }
            // The cell's first column speaks for all of them.
            if (((block.y() | block.z()) & (kCellSide - 1)) == 0) {
                addTile(2, block);
            }
            block.x() |= kCellSide - 1;
        }
    }

  private:
    void addTile(unsigned level, const Coord& block) {
        mTree.addTile(level, mLattice.inGrid(block) << kBlockLog2, 1.0F, true);
    }

    Tree& mTree;
    const VoxelLattice& mLattice;
    std::map<int, int> mColumns;  // that are solid all through a cell, by its place along x
};

void addGroup(const ColumnGroup& group, const VoxelLattice& lattice,
              std::vector<ColumnVoxels>& columns, Tree& tree) {
    const auto forEachColumn = [&](const auto& visit) {
        for (Coord block = group.begin; block.y() < group.end.y(); ++block.y()) {
            for (block.z() = group.begin.z(); block.z() < group.end.z(); ++block.z()) {
                const Coord place = block - lattice.firstBlock;
                visit(block, columns[static_cast<std::size_t>(place.y()) * lattice.blockCount.z() +
                                     place.z()]);
            }
        }
    };
    SolidTiles tiles(tree, lattice);
    forEachColumn([&](const Coord&, const ColumnVoxels& column) {
        for (const SolidRun& run : column.solid) tiles.count(run);
    });
    forEachColumn([&](const Coord& block, ColumnVoxels& column) {
        for (const SolidRun& run : column.solid) tiles.add(block, run);
        for (auto& leaf : column.leaves) tree.addLeaf(leaf.release());
        column = {};
    });
}

}  // namespace

VoxelResult assembleVoxels(const std::string& source, const VoxelLattice& lattice,
                           const VoxelOptions& options, std::vector<ColumnVoxels>& columns) {
    VoxelResult result;
    std::int64_t eighths = 0;
    for (const ColumnVoxels& column : columns) {
        result.voxels += column.voxels;
        eighths += column.eighths;
    }
    if (result.voxels == 0) {
        std::ostringstream message;
        message << source << ": no voxel" << (options.subSamples() ? "" : "'s centre")
                << " is inside; expected voxels smaller than " << lattice.voxelSize
                << " world units";
        throw Error(ErrorKind::Result, message.str());
    }
    result.volume = static_cast<double>(eighths) / kSubSamples * std::pow(lattice.voxelSize, 3);
    result.grid = openvdb::FloatGrid::create(0.0F);
    for (const ColumnGroup& group : groupColumns(lattice)) {
        addGroup(group, lattice, columns, result.grid->tree());
    }
    result.grid->setTransform(openvdb::math::Transform::createLinearTransform(lattice.voxelSize));
    result.grid->setName("density");
    result.grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    result.grid->setCreator(std::string("bandvox ") + version());
    setVoxelMetadata(*result.grid, source);
    return result;
}

VoxelResult assembleMeshVoxels(const std::string& source, const VoxelLattice& lattice,
                               const VoxelOptions& options, std::vector<ColumnVoxels>& columns) {
    if (!std::all_of(columns.begin(), columns.end(), [](const auto& c) { return c.isClosed; })) {
        throw Error(ErrorKind::Input, source +
                                          ": the mesh is not closed: a line enters it "
                                          "more or less often than it leaves it");
    }
    const bool isInsideOut = std::any_of(columns.begin(), columns.end(),
                                         [](const auto& column) { return column.isInsideOut; });
    VoxelResult result = assembleVoxels(source, lattice, options, columns);
    if (isInsideOut) {
        result.warnings.emplace_back(
            "parts of the surface are inside out; what they enclose counts as outside");
    }
    return result;
}

}  // namespace bandvox

#include "core/words.h"
#include "grid/joint_reader.h"
#include "grid/merge_metadata.h"
#include "grid/merge_values.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/merge_grids.h>
#include <bandvox/grid/same_lattice.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace bandvox {

namespace {

using MergeLeaf = JointReader::Leaf;

// What a cube of the lattice became.
struct MergedPart {
    struct Tile {
        openvdb::Coord origin;
        openvdb::Index level;
        float value;
    };
    std::vector<Tile> tiles;
    std::vector<std::unique_ptr<MergeLeaf>> leaves;

    void moveTo(openvdb::FloatTree& tree) {
        for (const Tile& tile : tiles) tree.addTile(tile.level, tile.origin, tile.value, true);
        for (auto& leaf : leaves) tree.addLeaf(leaf.release());
        tiles.clear();
        leaves.clear();
    }
};

class CubeMerger {
  public:
    CubeMerger(const std::vector<JointGrid>& grids, const MergeRule& rule)
        : mReader(grids), mRule(rule), mConstants(grids.size()) {}

    // A cube of any side as one tile, if that is what it is; else its blocks.
    void merge(const JointCube& cube, MergedPart& part) {
        constexpr int kBlock = MergeLeaf::DIM;
        if (mergeWhole(cube, part)) return;
        if (cube.side == kBlock) return mergeBlock(cube.origin, part);
        openvdb::Coord at;
        const openvdb::Coord end = cube.origin.offsetBy(cube.side);
        for (at[0] = cube.origin[0]; at[0] < end[0]; at[0] += kBlock) {
            for (at[1] = cube.origin[1]; at[1] < end[1]; at[1] += kBlock) {
                for (at[2] = cube.origin[2]; at[2] < end[2]; at[2] += kBlock) {
                    merge({at, kBlock}, part);
                }
            }
        }
    }

  private:
    bool mergeWhole(const JointCube& cube, MergedPart& part) {
        bool isConstant = true;
        std::optional<float> decided;
        for (std::size_t i = 0; i < mConstants.size(); ++i) {
            mConstants[i] = mReader.constantIn(i, cube);
            isConstant = isConstant && mConstants[i];
            if (!decided && mConstants[i]) decided = mRule.decidedBy(i, mConstants[i]->value);
        }
        if (!isConstant && !decided) return false;
        if (!decided) {
            double sum = 0;
            for (std::size_t i = 0; i < mConstants.size(); ++i) {
                mRule.take(i, &mConstants[i]->value, 1, &sum);
            }
            decided = mRule.finished(sum);
        }
        addTile(cube, *decided, part);
        return true;
    }

    static void addTile(const JointCube& cube, float value, MergedPart& part) {
        if (value == 0) return;
        const openvdb::Index level = cube.side == 8 ? 1 : cube.side == 128 ? 2 : 3;
        part.tiles.push_back({cube.origin, level, value});
    }

    // Called after mergeWhole for the same block.
    void mergeBlock(const openvdb::Coord& origin, MergedPart& part) {
        std::array<float, MergeLeaf::SIZE> values{};
        std::array<double, MergeLeaf::SIZE> sums{};
        MergeLeaf::NodeMaskType active;
        for (std::size_t i = 0; i < mConstants.size(); ++i) {
            if (mConstants[i]) {
                values.fill(mConstants[i]->value);
            } else {
                mReader.readBlock(i, origin, values.data(), active);
            }
            mRule.take(i, values.data(), values.size(), sums.data());
        }
        auto leaf = std::make_unique<MergeLeaf>(origin, 0.0F);
        float* to = leaf->buffer().data();
        bool isConstant = true;
        active.setOff();
        for (openvdb::Index i = 0; i < MergeLeaf::SIZE; ++i) {
            to[i] = mRule.finished(sums[i]);
            if (to[i] != 0) active.setOn(i);
            isConstant = isConstant && to[i] == to[0];
        }
        if (isConstant) return addTile({origin, MergeLeaf::DIM}, to[0], part);
        leaf->setValueMask(active);
        part.leaves.push_back(std::move(leaf));
    }

    JointReader mReader;
    const MergeRule& mRule;
    std::vector<std::optional<ConstantCube>> mConstants;  // of the cube at hand
};

void requireMergeOptions(const MergeOptions& options, std::size_t grids) {
    const auto fail = [](const std::string& message) { throw Error(ErrorKind::Usage, message); };
    if (!(options.threshold >= 0 && std::isfinite(options.threshold))) {
        fail("the threshold of merging is " + inShort(options.threshold) +
             "; it must be 0 or more");
    }
    if (options.weights.empty()) return;
    const bool isBlend = options.operation == MergeOperation::Blend;
    if (!isBlend && options.operation != MergeOperation::Sum) {
        fail("weights are for sum and blend, and the operation is " + nameOf(options.operation));
    }
    if (options.weights.size() != grids) {
        fail("there are " + counted(options.weights.size(), "weight", "weights") + " for " +
             counted(grids, "grid", "grids") + "; expected one for each");
    }
    double sum = 0;
    for (const double weight : options.weights) {
        if (!std::isfinite(weight) || (isBlend && weight < 0)) {
            fail("a weight is " + inShort(weight) + "; it must be " +
                 (isBlend ? "0 or more" : "finite"));
        }
        sum += weight;
    }
    if (isBlend && !(sum > 0)) fail("all weights are 0; expected one above 0 at least");
}

void requireDensity(const openvdb::FloatGrid& grid) {
    const std::string name = "the grid \"" + grid.getName() + "\" ";
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw Error(ErrorKind::Input, name +
                                          "is a level set; expected a density, which is 0 "
                                          "outside and 1 inside");
    }
    if (grid.background() != 0) {
        throw Error(ErrorKind::Input, name + "has the background " + inShort(grid.background()) +
                                          "; expected a density, with background 0");
    }
}

std::vector<JointGrid> jointGrids(const std::vector<openvdb::FloatGrid::ConstPtr>& grids) {
    std::vector<JointGrid> joint;
    for (const auto& grid : grids) {
        const auto offset = wholeVoxelOffset(grids.front()->transform(), grid->transform());
        if (!offset) {
            throw Error(ErrorKind::Input,
                        "the grids \"" + grids.front()->getName() + "\" and \"" + grid->getName() +
                            "\" are on different lattices: " +
                            latticeDifference(grids.front()->transform(), grid->transform()));
        }
        joint.push_back({grid.get(), *offset});
    }
    return joint;
}

openvdb::FloatGrid::Ptr mergeJoint(const std::vector<JointGrid>& grids, const MergeRule& rule,
                                   Progress& progress) {
    const std::vector<JointCube> cubes = jointCubes(grids);
    std::vector<MergedPart> parts(cubes.size());
    const ProgressStage stage(progress, "merging", static_cast<std::int64_t>(cubes.size()));
    parallelFor(static_cast<std::int64_t>(cubes.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto at = static_cast<std::size_t>(i);
        CubeMerger(grids, rule).merge(cubes[at], parts[at]);
        progress.advance();
    });
    auto merged = openvdb::FloatGrid::create(0.0F);
    for (MergedPart& part : parts) {
        progress.throwIfInterrupted();
        part.moveTo(merged->tree());
    }
    openvdb::tools::pruneTiles(merged->tree(), 0.0F, /*threaded=*/false);
    return merged;
}

}  // namespace

std::string nameOf(MergeOperation operation) {
    constexpr std::array<const char*, 6> kNames{"union", "sum",        "max",
                                                "blend", "difference", "intersection"};
    return kNames[static_cast<std::size_t>(operation)];
}

MergeResult mergeGrids(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                       const MergeOptions& options, Progress& progress) {
    if (grids.size() < 2) {
        throw Error(ErrorKind::Usage,
                    "merging takes two grids at least, but got " + std::to_string(grids.size()));
    }
    requireMergeOptions(options, grids.size());
    double bytes = 0;
    for (const auto& grid : grids) {
        if (!grid) throw Error(ErrorKind::Usage, "merging needs grids, but one is missing");
        requireDensity(*grid);
        bytes += static_cast<double>(grid->memUsage());
    }
    const std::vector<JointGrid> joint = jointGrids(grids);
    requireMemory(bytes, "the merged grid");

    const MergeRule rule(options, grids.size());
    MergeResult result;
    result.grid = mergeJoint(joint, rule, progress);
    if (result.grid->tree().empty()) {
        throw Error(ErrorKind::Result, "the " + nameOf(options.operation) +
                                           " of the grids is empty: no density is left");
    }
    const openvdb::FloatGrid& first = *grids.front();
    result.grid->setTransform(first.transform().copy());
    result.grid->setName(first.getName());
    result.grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    describeMerged(grids, options, rule, result);
    return result;
}

}  // namespace bandvox

#include "core/words.h"
#include "grid/poisson_function.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/oriented_points_to_solid_grid.h>

#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace bandvox {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

using FieldLeaf = openvdb::FloatTree::LeafNodeType;
constexpr int kLeafSide = FieldLeaf::DIM;
constexpr std::size_t kLeafBits = FieldLeaf::LOG2DIM;
constexpr int kLeafNodes = kLeafSide + 1;

constexpr std::size_t kFewestPoints = 10;

/// How far the surface is followed from the box of the points, of that box's diagonal.
constexpr double kReach = 0.25;

/// What is farther than so many spacings from all points is said to be a guess.
constexpr double kSupport = 4;

/// The share of such a surface that is worth a word.
constexpr double kGuessedShare = 0.01;

constexpr double kFarthestNode = 1e9;

/// What lies beyond where the surface is followed, in the function's own units.
constexpr float kBeyond = 1;

struct Chosen {
    std::vector<Vec3d> points;
    std::vector<openvdb::Vec3f> normals;  // of length 1
};

Chosen withNormals(const OrientedPoints& all) {
    Chosen chosen;
    chosen.points.reserve(all.points.size());
    chosen.normals.reserve(all.points.size());
    for (std::size_t i = 0; i < all.points.size(); ++i) {
        const Vec3d normal(all.normals[i]);
        const double length = normal.length();
        if (!(length > 0)) continue;
        chosen.points.push_back(all.points[i]);
        chosen.normals.emplace_back(normal / length);
    }
    return chosen;
}

/// Follows the surface of a function from leaf to leaf.
class SurfaceWalk {
  public:
    SurfaceWalk(const PoissonFunction& function, const openvdb::math::Transform::Ptr& lattice,
                const openvdb::BBoxd& within, Progress& progress)
        : mFunction(function), mWithin(within), mProgress(progress) {
        mGrid = openvdb::FloatGrid::create(kBeyond);
        mGrid->setTransform(lattice);
    }

    void run(const std::vector<Vec3d>& points) {
        const ProgressStage stage(mProgress, "following the surface", 0);
        std::vector<Coord> blocks = crossedLeaves(points);
        while (!blocks.empty()) {
            mProgress.throwIfInterrupted();
            std::vector<Coord> leaves;
            for (const Coord& block : blocks) {
                for (int i = 0; i < 8; ++i) leaves.push_back(above(block, i));
            }
            readLeaves(std::move(leaves));
            blocks = neighborsAcross(blocks);
        }
    }

    const openvdb::FloatGrid::Ptr& grid() const { return mGrid; }
    /// First nodes of blocks of 8³ cells that the surface passes.
    const std::vector<Coord>& crossed() const { return mCrossed; }
    bool wasCut() const { return mWasCut; }

  private:
    static Coord above(const Coord& block, int corner) {
        return block.offsetBy((corner & 1) * kLeafSide, (corner >> 1 & 1) * kLeafSide,
                              (corner >> 2) * kLeafSide);
    }

    static void makeUnique(std::vector<Coord>& places) {
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
    }

    /// Leaves with a point in them that the surface passes.
    std::vector<Coord> crossedLeaves(const std::vector<Vec3d>& points) {
        std::vector<Coord> leaves;
        leaves.reserve(points.size());
        for (const Vec3d& point : points) {
            leaves.push_back(Coord::floor(mGrid->worldToIndex(point)) & ~(kLeafSide - 1));
        }
        makeUnique(leaves);
        readLeaves(leaves);
        const auto accessor = mGrid->getConstAccessor();
        std::erase_if(leaves, [&](const Coord& leaf) {
            const float* values = accessor.probeConstLeaf(leaf)->buffer().data();
            return std::all_of(values, values + FieldLeaf::SIZE,
                               [&](float value) { return (value < 0) == (values[0] < 0); });
        });
        for (const Coord& leaf : leaves) mSeen.setValueOn(leaf >> kLeafBits);
        return leaves;
    }

    /// Reads the function at the nodes of leaves that are not there yet.
    void readLeaves(std::vector<Coord> origins) {
        makeUnique(origins);
        const auto accessor = mGrid->getConstAccessor();
        std::erase_if(origins,
                      [&](const Coord& leaf) { return accessor.probeConstLeaf(leaf) != nullptr; });
        std::vector<FieldLeaf*> leaves;
        for (const Coord& origin : origins) {
            leaves.push_back(new FieldLeaf(origin, kBeyond, true));
            mGrid->tree().addLeaf(leaves.back());  // which takes ownership
        }
        parallelFor(std::ssize(leaves), [&](std::int64_t i) {
            if (!mProgress.interrupted()) readLeaf(*leaves[i]);
        });
        mProgress.throwIfInterrupted();
    }

    void readLeaf(FieldLeaf& leaf) const {
        std::array<Vec3d, FieldLeaf::SIZE> places;
        // Forth and back, so that each place is near the one before.
        const auto offset = [](int i) {
            const int x = i >> 6;
            const int y = (x & 1) != 0 ? 7 - (i >> 3 & 7) : i >> 3 & 7;
            const int z = (i >> 3 & 1) != 0 ? 7 - (i & 7) : i & 7;
            return x << 6 | y << 3 | z;
        };
        for (int i = 0; i < int(FieldLeaf::SIZE); ++i) {
            places[i] = mGrid->indexToWorld(leaf.offsetToGlobalCoord(offset(i)));
        }
        std::array<float, FieldLeaf::SIZE> values;
        mFunction.read(places, values);
        for (int i = 0; i < int(FieldLeaf::SIZE); ++i) {
            const bool isBeyond = !mWithin.isInside(places[i]);
            leaf.setValueOn(offset(i), isBeyond ? kBeyond : values[i]);
        }
    }

    /// The blocks that the surface goes on to from those given, and that were not seen before.
    std::vector<Coord> neighborsAcross(const std::vector<Coord>& blocks) {
        std::vector<Coord> next;
        for (const Coord& block : blocks) {
            const unsigned faces = crossedFaces(block);
            if (faces != 0) mCrossed.push_back(block);
            for (int face = 0; face < 6; ++face) {
                if ((faces >> face & 1) == 0) continue;
                Coord beside = block;
                beside[face / 2] += (face & 1) != 0 ? kLeafSide : -kLeafSide;
                if (mSeen.isValueOn(beside >> kLeafBits)) continue;
                mSeen.setValueOn(beside >> kLeafBits);
                next.push_back(beside);
            }
        }
        return next;
    }

    /// Bit 2a + s: the block's lower or upper side along axis a has nodes of both signs. Bit 6: the
    /// block has.
    unsigned crossedFaces(const Coord& block) {
        const auto accessor = mGrid->getConstAccessor();
        std::array<bool, kLeafNodes * kLeafNodes * kLeafNodes> inside;
        const auto at = [&](int x, int y, int z) -> bool& {
            return inside[(x * kLeafNodes + y) * kLeafNodes + z];
        };
        for (int x = 0; x < kLeafNodes; ++x) {
            for (int y = 0; y < kLeafNodes; ++y) {
                for (int z = 0; z < kLeafNodes; ++z) {
                    at(x, y, z) = accessor.getValue(block.offsetBy(x, y, z)) < 0;
                }
            }
        }
        const bool isMixed =
            std::any_of(inside.begin(), inside.end(), [&](bool node) { return node != inside[0]; });
        unsigned faces = isMixed ? 1U << 6 : 0;
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) {
                Coord node(0);
                node[axis] = side * kLeafSide;
                const bool first = at(node[0], node[1], node[2]);
                bool isCrossed = false;
                for (int u = 0; u < kLeafNodes; ++u) {
                    for (int v = 0; v < kLeafNodes; ++v) {
                        node[(axis + 1) % 3] = u;
                        node[(axis + 2) % 3] = v;
                        isCrossed |= at(node[0], node[1], node[2]) != first;
                    }
                }
                if (isCrossed) faces |= 1U << (2 * axis + side);
            }
        }
        const openvdb::BBoxd box(mGrid->indexToWorld(block),
                                 mGrid->indexToWorld(block.offsetBy(kLeafSide)));
        if (faces != 0 && !(mWithin.isInside(box.min()) && mWithin.isInside(box.max()))) {
            mWasCut = true;
        }
        return faces;
    }

    const PoissonFunction& mFunction;
    openvdb::BBoxd mWithin;
    Progress& mProgress;
    openvdb::FloatGrid::Ptr mGrid;
    openvdb::MaskTree mSeen;  // blocks, by their numbers
    std::vector<Coord> mCrossed;
    bool mWasCut = false;
};

/// The share of blocks that are farther than `reach` from all points, world units.
double shareFarFrom(const std::vector<Vec3d>& points, const SurfaceWalk& walk, double reach) {
    openvdb::MaskTree near;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(near);
    const auto cell = [&](const Vec3d& place) { return Coord::floor(place / reach); };
    for (const Vec3d& point : points) accessor.setValueOn(cell(point));
    accessor.clear();
    openvdb::tools::dilateActiveValues(near, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
    std::size_t far = 0;
    for (const Coord& block : walk.crossed()) {
        const Vec3d middle =
            walk.grid()->indexToWorld(block.asVec3d() + Vec3d(0.5 * double(kLeafSide)));
        if (!near.isValueOn(cell(middle))) ++far;
    }
    return double(far) / double(std::max<std::size_t>(walk.crossed().size(), 1));
}

/// True if the function falls along most normals.
bool pointInward(const PoissonFunction& function, const Chosen& chosen) {
    constexpr std::size_t kMost = 2000;
    const std::size_t step = std::max<std::size_t>(chosen.points.size() / kMost, 1);
    std::size_t inward = 0, all = 0;
    for (std::size_t i = 0; i < chosen.points.size(); i += step) {
        const Vec3d offset = function.spacing() * Vec3d(chosen.normals[i]);
        const std::array<Vec3d, 2> places{chosen.points[i] - offset, chosen.points[i] + offset};
        std::array<float, 2> values{};
        function.read(places, values);
        ++all;
        if (values[1] < values[0]) ++inward;
    }
    return 2 * inward > all;
}

std::string percent(double share) {
    return inShort(100 * share) + " %";
}

void addPointWarnings(OrientedPointsGrid& result, std::size_t count) {
    if (result.withoutNormal > 0) {
        result.warnings.push_back(counted(result.withoutNormal, "point", "points") + " of " +
                                  std::to_string(count) + " were left out, as their normal is 0");
    }
    if (result.turned) {
        result.warnings.push_back("the normals point inward; they were turned");
    }
    if (result.unsupported > kGuessedShare) {
        result.warnings.push_back(percent(result.unsupported) +
                                  " of the surface is a guess, farther than " + inShort(kSupport) +
                                  " times the points' spacing from all of them");
    }
    if (result.cut) {
        result.warnings.push_back(
            "the surface leaves the box of the points, and was cut off around it; expected points "
            "all over a closed surface");
    }
}

openvdb::math::Transform::Ptr latticeFor(const openvdb::BBoxd& box, double side) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        reach = std::max({reach, std::abs(box.min()[axis]), std::abs(box.max()[axis])});
    }
    if (!(reach / side < kFarthestNode)) {
        throw Error(ErrorKind::Input, "the points reach to " + inShort(reach) +
                                          " from the origin, and the lattice's side is " +
                                          inShort(side) + "; expected a larger voxel size");
    }
    return openvdb::math::Transform::createLinearTransform(side);
}

}  // namespace

OrientedPointsGrid orientedPointsToSolidGrid(const OrientedPoints& points, double voxelSize,
                                             Progress& progress) {
    if (!(voxelSize > 0)) {
        throw Error(ErrorKind::Usage, "the voxel size for points is " + inShort(voxelSize) +
                                          "; expected more than 0");
    }
    if (points.points.size() != points.normals.size()) {
        throw Error(ErrorKind::Usage, "there are " + std::to_string(points.points.size()) +
                                          " points and " + std::to_string(points.normals.size()) +
                                          " normals; expected as many");
    }
    const Chosen chosen = withNormals(points);
    OrientedPointsGrid result;
    result.withoutNormal = points.points.size() - chosen.points.size();
    if (chosen.points.size() < kFewestPoints) {
        throw Error(ErrorKind::Input,
                    "there " + std::string(chosen.points.size() == 1 ? "is " : "are ") +
                        counted(chosen.points.size(), "point", "points") +
                        " with a normal; expected " + std::to_string(kFewestPoints) + " at least");
    }
    const PoissonFunction function({chosen.points, chosen.normals}, progress);
    result.spacing = function.spacing();
    result.turned = pointInward(function, chosen);

    openvdb::BBoxd box;
    for (const Vec3d& point : chosen.points) box.expand(point);
    openvdb::BBoxd within = box;
    within.expand(kReach * box.extents().length());
    const double side =
        0.5 * (result.spacing > 0 ? std::min(voxelSize, result.spacing) : voxelSize);
    SurfaceWalk walk(function, latticeFor(within, side), within, progress);
    walk.run(chosen.points);
    if (walk.crossed().empty()) {
        throw Error(ErrorKind::Result,
                    "no surface passes near the points; expected more of them, with normals that "
                    "agree");
    }
    result.cut = walk.wasCut();
    result.unsupported = shareFarFrom(chosen.points, walk, kSupport * result.spacing);
    addPointWarnings(result, points.points.size());

    // What was not read lies on the side of what is beside it.
    result.grid = walk.grid();
    openvdb::tools::signedFloodFillWithValues(result.grid->tree(), kBeyond, -kBeyond);
    result.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    result.grid->setName("points");
    return result;
}

}  // namespace bandvox

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/array_box.h>
#include <bandvox/resample/resample_vectors.h>

#include <openvdb/tools/Prune.h>

#include <array>
#include <vector>

namespace bandvox {

namespace {

using VectorLeaf = openvdb::Vec3STree::LeafNodeType;

// Where less than this of a new voxel is filled by vectors, there is none.
constexpr float kLeastFilled = 0.1F;

// A number for each active vector, 0 elsewhere.
template <typename Number>
openvdb::FloatGrid::Ptr numbersOf(const openvdb::Vec3SGrid& grid, const Number& number) {
    auto tree = std::make_shared<openvdb::FloatTree>(grid.tree(), 0.0F, openvdb::TopologyCopy());
    auto result = openvdb::FloatGrid::create(tree);
    result->setTransform(grid.transform().copy());
    result->setName(grid.getName());
    std::vector<const VectorLeaf*> from;
    std::vector<openvdb::FloatTree::LeafNodeType*> to;
    grid.tree().getNodes(from);
    tree->getNodes(to);
    parallelFor(static_cast<std::int64_t>(from.size()), [&](std::int64_t i) {
        const auto leaf = static_cast<std::size_t>(i);
        for (auto value = from[leaf]->cbeginValueOn(); value; ++value) {
            to[leaf]->setValueOnly(value.pos(), number(*value));
        }
    });
    auto tile = grid.cbeginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::Index level = openvdb::Vec3STree::DEPTH - 1 - tile.getDepth();
        tree->addTile(level, tile.getCoord(), number(*tile), true);
    }
    return result;
}

}  // namespace

openvdb::Vec3SGrid::Ptr resampleVectors(const openvdb::Vec3SGrid::ConstPtr& source,
                                        const openvdb::math::Transform& target,
                                        const ResampleOptions& options, Progress& progress) {
    if (!source) throw Error(ErrorKind::Usage, "resampling needs a grid, but got none");
    const auto resampled = [&](const auto& number) {
        return resampleGrid(numbersOf(*source, number), target, options, progress).grid;
    };
    const auto filled = resampled([](const openvdb::Vec3s& /*vector*/) { return 1.0F; });
    std::array<openvdb::FloatGrid::Ptr, 3> components;
    for (int c = 0; c < 3; ++c) {
        components[c] = resampled([c](const openvdb::Vec3s& vector) { return vector[c]; });
    }

    auto result = openvdb::Vec3SGrid::create(source->background());
    openvdb::Vec3STree& tree = result->tree();
    tree.topologyUnion(filled->tree());
    tree.voxelizeActiveTiles();
    std::vector<VectorLeaf*> leaves;
    tree.getNodes(leaves);
    parallelFor(static_cast<std::int64_t>(leaves.size()), [&](std::int64_t i) {
        VectorLeaf& leaf = *leaves[static_cast<std::size_t>(i)];
        const auto weight = filled->getConstAccessor();
        std::array<openvdb::FloatGrid::ConstAccessor, 3> from{components[0]->getConstAccessor(),
                                                              components[1]->getConstAccessor(),
                                                              components[2]->getConstAccessor()};
        for (openvdb::Index v = 0; v < VectorLeaf::SIZE; ++v) {
            const openvdb::Coord at = leaf.offsetToGlobalCoord(v);
            const float part = weight.getValue(at);
            if (part < kLeastFilled) {
                leaf.setValueOff(v, source->background());
                continue;
            }
            const openvdb::Vec3s sum(from[0].getValue(at), from[1].getValue(at),
                                     from[2].getValue(at));
            leaf.setValueOn(v, sum / part);
        }
    });
    openvdb::tools::pruneInactive(tree);
    openvdb::tools::pruneTiles(tree, openvdb::Vec3s(0.0F));
    static_cast<openvdb::MetaMap&>(*result) = static_cast<const openvdb::MetaMap&>(*source);
    dropArrayBox(*result);
    result->setTransform(target.copy());
    return result;
}

}  // namespace bandvox

#include "grid/spooled_grid.h"

#include "grid/leaf_writing.h"

#include <cstddef>
#include <ostream>
#include <utility>
#include <vector>

namespace bandvox {

SpooledGrid::SpooledGrid(openvdb::FloatTree::Ptr tree, std::shared_ptr<const LeafSpool> spool)
    : openvdb::FloatGrid(std::move(tree)), mSpool(std::move(spool)) {}

openvdb::GridBase::ConstPtr SpooledGrid::copyGrid() const {
    const auto shared = openvdb::ConstPtrCast<openvdb::FloatTree>(constTreePtr());
    auto copy = std::make_shared<SpooledGrid>(shared, mSpool);
    static_cast<openvdb::MetaMap&>(*copy) = static_cast<const openvdb::MetaMap&>(*this);
    copy->setTransform(transform().copy());
    return copy;
}

openvdb::GridBase::Ptr SpooledGrid::copyGrid() {
    return openvdb::ConstPtrCast<openvdb::GridBase>(std::as_const(*this).copyGrid());
}

openvdb::Index64 SpooledGrid::memUsage() const {
    return openvdb::FloatGrid::memUsage() +
           openvdb::Index64(tree().leafCount()) * LeafSpool::Leaf::SIZE * sizeof(float);
}

void SpooledGrid::writeBuffers(std::ostream& stream) const {
    using Leaf = LeafSpool::Leaf;
    std::vector<const Leaf*> leaves;
    tree().getNodes(leaves);
    const bool half = saveFloatAsHalf();
    writeByAllThreads(stream, leaves.size(), [&](std::size_t i, std::ostream& part) {
        Leaf whole(leaves[i]->origin());
        whole.setValueMask(leaves[i]->getValueMask());
        mSpool->read(leaves[i]->transientData(), whole);
        writeLeaf(whole, part, half);
    });
}

}  // namespace bandvox

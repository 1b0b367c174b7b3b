#pragma once

#include "grid/leaf_spool.h"

#include <openvdb/openvdb.h>

#include <iosfwd>
#include <memory>

namespace bandvox {

/// A grid of which the tree's nodes, without the values of its leaves, are in memory. It is written
/// as the whole grid would be; elsewhere the values are 0.
///
/// A leaf's transient data is its number in the spool.
class SpooledGrid final : public openvdb::FloatGrid {
  public:
    SpooledGrid(openvdb::FloatTree::Ptr tree, std::shared_ptr<const LeafSpool> spool);

    /// Shares the tree and the spool.
    openvdb::GridBase::Ptr copyGrid() override;
    openvdb::GridBase::ConstPtr copyGrid() const override;

    /// What the whole grid would take, since the file states it.
    openvdb::Index64 memUsage() const override;

    using openvdb::FloatGrid::writeBuffers;
    void writeBuffers(std::ostream& stream) const override;

  private:
    std::shared_ptr<const LeafSpool> mSpool;
};

}  // namespace bandvox

#pragma once

#include "grid/guarded_reads.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <istream>
#include <ostream>

namespace bandvox {

/// OpenVDB's archive on streams of our own: openvdb::io::File does not notice a full disk, and
/// openvdb::io::Stream does not say which grid it reads.
class VdbArchive : public openvdb::io::Archive {
  public:
    /// All grids of a stream, whose buffer is guarded. Throws what OpenVDB and the stream throw.
    openvdb::GridPtrVec read(std::istream& stream, GuardedBuffer& buffer);

    /// Writes grids, those that share a tree as instances of the first. `seekable`: places in the
    /// stream are noted in it, so that readers find grids without reading those before.
    void writeGrids(std::ostream& stream, const openvdb::GridCPtrVec& grids, bool seekable) const;

  private:
    void writeWhole(openvdb::io::GridDescriptor& descriptor, const openvdb::GridBase& grid,
                    openvdb::io::StreamMetadata::Ptr& ofFile, std::ostream& stream,
                    bool seekable) const;
};

}  // namespace bandvox

#pragma once

#include <openvdb/openvdb.h>

namespace bandvox {

/// A grid that shares the tree, the metadata and the transform of another and writes the same
/// bytes, its leaves by all threads at once where its type is among those that are large.
openvdb::GridBase::Ptr writtenByAllThreads(const openvdb::GridBase& grid);

}  // namespace bandvox

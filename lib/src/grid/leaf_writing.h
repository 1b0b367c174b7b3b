#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>
#include <ostream>

namespace bandvox {

/// Writes `count` leaf nodes in their order: writeLeaf(i, part) writes the buffers of number i to a
/// stream that tells of the file what `stream` does. All threads do so at once.
void writeByAllThreads(std::ostream& stream, std::size_t count,
                       const std::function<void(std::size_t, std::ostream&)>& writeLeaf);

/// Writes what `leaf.writeBuffers` does. That looks at each value by itself; this is quicker for
/// leaves whose inactive values are the background, as those of densities are.
void writeLeaf(const openvdb::FloatTree::LeafNodeType& leaf, std::ostream& stream, bool half);

/// A grid that shares the tree, the metadata and the transform of another and writes the same
/// bytes, its leaves by all threads at once where its type is among those that are large.
openvdb::GridBase::Ptr writtenByAllThreads(const openvdb::GridBase& grid);

}  // namespace bandvox

#pragma once

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace bandvox {

/// Values of leaf nodes, floats, in a temporary file that has no name: whatever becomes of the
/// process, nothing is left. Each node has its number, from 0.
class LeafSpool {
  public:
    using Leaf = openvdb::FloatTree::LeafNodeType;

    /// For the file that is written of it in the end, in whose folder it takes its room. Throws
    /// Error(ErrorKind::Runtime), which names that file, if none can be made there.
    explicit LeafSpool(std::filesystem::path target);
    ~LeafSpool();
    LeafSpool(const LeafSpool&) = delete;
    LeafSpool& operator=(const LeafSpool&) = delete;

    /// Keeps the values of nodes, the first of them as number `first`; those that were there are
    /// lost. May be called by several threads at once, for different numbers. Throws
    /// Error(ErrorKind::Runtime) if there is no room.
    void write(std::uint32_t first, std::span<const std::unique_ptr<Leaf>> leaves);

    /// The values of a node. May be called by several threads at once. Throws
    /// Error(ErrorKind::Runtime) if they cannot be read.
    void read(std::uint32_t number, Leaf& leaf) const;

  private:
    [[noreturn]] void fail(const std::string& why) const;

    std::filesystem::path mTarget;
    int mDescriptor = -1;
};

}  // namespace bandvox

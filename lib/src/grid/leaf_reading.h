#pragma once

#include "grid/guarded_reads.h"

#include <openvdb/openvdb.h>

#include <functional>

namespace bandvox {

/// Reads a grid whose type and name are known, its leaves by all threads at once where its type is
/// among those that are large. `read` is to have OpenVDB read the grid that it is handed, from the
/// stream of `buffer`.
void readByAllThreads(const openvdb::GridBase::Ptr& grid, GuardedBuffer& buffer,
                      const std::function<void(const openvdb::GridBase::Ptr&)>& read);

}  // namespace bandvox

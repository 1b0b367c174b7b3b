#pragma once

#include <bandvox/core/parallel.h>
#include <bandvox/core/progress.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace bandvox {

/// What `examine(leaf)` finds in each of the leaves, in their order. Throws
/// Error(ErrorKind::Interrupted) if the caller wants to stop.
template <typename Leaf, typename Examine>
auto examineLeaves(const std::vector<const Leaf*>& leaves, const Progress& progress,
                   const Examine& examine) {
    constexpr std::size_t kLeavesPerTask = 256;
    std::vector<std::invoke_result_t<Examine, const Leaf&>> found(leaves.size());
    const std::size_t tasks = (leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask;
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
        const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
        for (std::size_t i = begin; i < end; ++i) found[i] = examine(*leaves[i]);
    });
    return found;
}

}  // namespace bandvox

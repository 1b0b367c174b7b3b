#pragma once

#include <cstddef>

namespace bandvox {

/// Counts the memory taken by `new`, in all threads, while it lives: the test program's
/// operators are replaced (allocation_meter.cpp).
class AllocationMeter {
  public:
    AllocationMeter();

    /// The most bytes that were held at a time since the meter was made, beyond those before.
    std::size_t peak() const;

  private:
    std::size_t mBefore;
};

}  // namespace bandvox

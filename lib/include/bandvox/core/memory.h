#pragma once

#include <cstdint>

namespace bandvox {

/// Bytes that this process could still take without being killed or swapping: what the kernel
/// counts as available, or less where a control group limits it.
std::int64_t availableMemory();

/// The bytes of memory that this process holds now; 0 if that is not known.
std::int64_t residentMemory();

/// The most bytes of memory that this process has held so far.
std::int64_t peakMemory();

/// Hands what has been freed back to the system, as far as the C library can; it would keep it for
/// later. Worth it after a stage that took much for a short time.
void returnFreeMemory();

/// Throws Error(ErrorKind::Memory), naming both numbers and `what`, if `bytes` is more than is
/// available now.
void requireMemory(double bytes, const char* what);

}  // namespace bandvox

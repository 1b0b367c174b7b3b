#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace bandvox {

/// Calls `body(i)` once for each i in [0, count), on the threads of TBB.
///
/// Meant for coarse work (a tile of a volume, a tile of an image): each call is a task of its
/// own. A result must depend on `i` alone, never on which thread ran it or when, so that it is
/// the same for any number of threads. An exception thrown by `body` cancels what has not
/// started and is rethrown here.
void parallelFor(std::int64_t count, const std::function<void(std::int64_t)>& body);

/// Calls `make(i)` for each i in [0, count), one after another on this thread, and `body(i)` after
/// it, on the threads of TBB while later ones are being made. What holds for parallelFor's results
/// holds here. An exception of either ends the making; that of the lowest i is rethrown.
void parallelAsMade(std::int64_t count, const std::function<void(std::int64_t)>& make,
                    const std::function<void(std::int64_t)>& body);

/// The number of threads that parallelFor uses at most, at least 1.
int threadCount();

/// Limits parallelFor, and everything else that runs on TBB, for as long as it lives.
class ThreadLimit {
  public:
    /// `threads` ≥ 1, or 0 for one per processor.
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> mImplementation;
};

}  // namespace bandvox

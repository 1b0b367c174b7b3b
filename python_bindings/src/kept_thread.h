#pragma once

#include <functional>

namespace bandvox::python {

/// A thread beside that of Python, for as long as this lives. Threads are kept for whoever comes
/// next: TBB's allocator never gives back what it has for a thread that has ended, some 8 kB, and
/// there is a call of Python for each.
class KeptThread {
  public:
    KeptThread();
    /// Waits for the work, and gives the thread back.
    ~KeptThread();
    KeptThread(const KeptThread&) = delete;
    KeptThread& operator=(const KeptThread&) = delete;

    /// Begins work that does not throw; once.
    void start(std::function<void()> work);

  private:
    struct Worker;
    struct Idle;
    static Idle& idle();

    Worker* mWorker;
};

}  // namespace bandvox::python

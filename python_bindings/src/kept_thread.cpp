#include "kept_thread.h"

#include <unistd.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace bandvox::python {

struct KeptThread::Worker {
    std::mutex mutex;
    std::condition_variable changed;
    std::function<void()> work;  // empty while there is none

    void run() {
        std::unique_lock lock(mutex);
        while (true) {
            changed.wait(lock, [this] { return static_cast<bool>(work); });
            lock.unlock();
            work();
            lock.lock();
            work = nullptr;
            changed.notify_all();
        }
    }
};

/// Threads that wait. A forked process has none of its parent's.
struct KeptThread::Idle {
    std::mutex mutex;
    std::vector<Worker*> workers;
    pid_t process = ::getpid();
};

// Threads wait until the process ends, so what they wait for has to be there as long.
KeptThread::Idle& KeptThread::idle() {
    static auto* const all = new Idle;
    return *all;
}

KeptThread::KeptThread() {
    Idle& all = idle();
    {
        const std::scoped_lock lock(all.mutex);
        if (all.process != ::getpid()) {
            all.workers.clear();
            all.process = ::getpid();
        }
        if (!all.workers.empty()) {
            mWorker = all.workers.back();
            all.workers.pop_back();
            return;
        }
    }
    auto worker = std::make_unique<Worker>();
    std::thread(&Worker::run, worker.get()).detach();
    mWorker = worker.release();
}

KeptThread::~KeptThread() {
    {
        std::unique_lock lock(mWorker->mutex);
        mWorker->changed.wait(lock, [this] { return !mWorker->work; });
    }
    Idle& all = idle();
    const std::scoped_lock lock(all.mutex);
    all.workers.push_back(mWorker);
}

void KeptThread::start(std::function<void()> work) {
    const std::scoped_lock lock(mWorker->mutex);
    mWorker->work = std::move(work);
    mWorker->changed.notify_all();
}

}  // namespace bandvox::python

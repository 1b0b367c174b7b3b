#include <bandvox/core/parallel.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

// TBB is not built with the thread sanitizer, so the sanitizer does not see that tasks start
// after they are spawned and end before the loop returns. These two calls say it.
#ifdef BANDVOX_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#define BANDVOX_HAPPENS_BEFORE(address) __tsan_release(address)
#define BANDVOX_HAPPENS_AFTER(address) __tsan_acquire(address)
#else
#define BANDVOX_HAPPENS_BEFORE(address)
#define BANDVOX_HAPPENS_AFTER(address)
#endif

namespace bandvox {

void parallelFor(std::int64_t count, const std::function<void(std::int64_t)>& body) {
    [[maybe_unused]] char spawned = 0;
    [[maybe_unused]] char finished = 0;
    BANDVOX_HAPPENS_BEFORE(&spawned);
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::int64_t>(0, count, 1),
        [&](const oneapi::tbb::blocked_range<std::int64_t>& range) {
            BANDVOX_HAPPENS_AFTER(&spawned);
            for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
            BANDVOX_HAPPENS_BEFORE(&finished);
        },
        oneapi::tbb::simple_partitioner());
    BANDVOX_HAPPENS_AFTER(&finished);
}

void parallelAsMade(std::int64_t count, const std::function<void(std::int64_t)>& make,
                    const std::function<void(std::int64_t)>& body) {
    if (threadCount() == 1) {
        for (std::int64_t i = 0; i < count; ++i) {
            make(i);
            body(i);
        }
        return;
    }
    [[maybe_unused]] char made = 0;
    [[maybe_unused]] char finished = 0;
    // All before the first that failed are done, so that it is the same whoever was quicker.
    std::atomic<std::int64_t> failed = count;
    std::exception_ptr error;
    std::mutex mutex;
    const auto attempt = [&](std::int64_t i, const auto& work) {
        try {
            work(i);
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            if (i >= failed) return;
            failed = i;
            error = std::current_exception();
        }
    };
    oneapi::tbb::task_group group;
    for (std::int64_t i = 0; i < failed; ++i) {
        attempt(i, make);
        if (i >= failed) break;
        BANDVOX_HAPPENS_BEFORE(&made);
        group.run([&, i] {
            BANDVOX_HAPPENS_AFTER(&made);
            if (i < failed) attempt(i, body);
            BANDVOX_HAPPENS_BEFORE(&finished);
        });
    }
    group.wait();
    BANDVOX_HAPPENS_AFTER(&finished);
    if (error) std::rethrow_exception(error);
}

int threadCount() {
    const std::size_t allowed = oneapi::tbb::global_control::active_value(
        oneapi::tbb::global_control::max_allowed_parallelism);
    return std::max(
        1, std::min(static_cast<int>(allowed), oneapi::tbb::this_task_arena::max_concurrency()));
}

struct ThreadLimit::Implementation {
    explicit Implementation(std::size_t threads)
        : control(oneapi::tbb::global_control::max_allowed_parallelism, threads) {}

    oneapi::tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    const std::size_t limit = threads > 0
                                  ? static_cast<std::size_t>(threads)
                                  : std::max<std::size_t>(1, std::thread::hardware_concurrency());
    mImplementation = std::make_unique<Implementation>(limit);
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace bandvox

#include "background.h"

#include "kept_thread.h"

#include <bandvox/core/parallel.h>

#include <chrono>
#include <exception>
#include <future>
#include <memory>

namespace bandvox::python {

namespace py = pybind11;

namespace {

constexpr std::chrono::milliseconds kBetweenLooks{20};
constexpr std::chrono::milliseconds kBetweenCalls{100};

}  // namespace

void WatchedProgress::begin(std::string_view stage, std::int64_t steps) {
    const std::scoped_lock lock(mMutex);
    mStage = stage;
    mSteps = steps;
    mDone = 0;
}

void WatchedProgress::end() {
    const std::scoped_lock lock(mMutex);
    if (mSteps > 0) mDone = mSteps;
}

std::pair<std::string, double> WatchedProgress::state() const {
    const std::scoped_lock lock(mMutex);
    if (mSteps <= 0) return {mStage, -1};
    return {mStage, std::min(1.0, static_cast<double>(mDone) / static_cast<double>(mSteps))};
}

void runInBackground(const std::function<void(Progress&)>& work, const py::object& callback,
                     int threads) {
    if (threads < 0) {
        throw Error(ErrorKind::Usage,
                    "threads is " + std::to_string(threads) + "; expected 0 or more");
    }
    WatchedProgress progress;
    std::packaged_task<void()> task([&] {
        std::unique_ptr<ThreadLimit> limit;
        if (threads > 0) limit = std::make_unique<ThreadLimit>(threads);
        work(progress);
    });
    std::future<void> done = task.get_future();
    std::exception_ptr stopped;
    {
        const py::gil_scoped_release unlocked;
        KeptThread worker;
        worker.start([&task] { task(); });
        auto called = std::chrono::steady_clock::now() - kBetweenCalls;
        while (done.wait_for(kBetweenLooks) != std::future_status::ready) {
            if (stopped) continue;
            const py::gil_scoped_acquire locked;
            const auto now = std::chrono::steady_clock::now();
            try {
                if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                if (!callback.is_none() && now - called >= kBetweenCalls) {
                    called = now;
                    const auto [stage, fraction] = progress.state();
                    callback(stage, fraction < 0 ? py::object(py::none())
                                                 : py::object(py::float_(fraction)));
                }
            } catch (...) {
                stopped = std::current_exception();
                progress.stop();
            }
        }
    }
    if (stopped) std::rethrow_exception(stopped);
    done.get();
}

}  // namespace bandvox::python

#pragma once

#include <bandvox/core/error.h>
#include <bandvox/core/progress.h>

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace bandvox::python {

/// What work says of itself, for the thread of Python that waits for it.
class WatchedProgress final : public Progress {
  public:
    void begin(std::string_view stage, std::int64_t steps) override;
    void advance(std::int64_t steps) override { mDone += steps; }
    void end() override;
    bool interrupted() const override { return mIsStopped; }

    void stop() { mIsStopped = true; }

    /// The stage, and how far it is, from 0 to 1; -1 where that is not known.
    std::pair<std::string, double> state() const;

  private:
    mutable std::mutex mMutex;
    std::string mStage;
    std::int64_t mSteps = 0;
    std::atomic<std::int64_t> mDone{0};
    std::atomic<bool> mIsStopped{false};
};

/// Runs `work` on a thread of its own without the interpreter's lock, while this one waits for it:
/// Ctrl-C stops it, and `callback`, if it is not None, is told of its progress as
/// callback(stage, fraction) ten times a second. What either throws is thrown here. `threads`: 0,
/// or the most that the work may use.
void runInBackground(const std::function<void(Progress&)>& work, const pybind11::object& callback,
                     int threads);

/// The same for work with a result.
template <typename Work>
auto inBackground(const pybind11::object& callback, int threads, const Work& work) {
    using Result = decltype(work(std::declval<Progress&>()));
    std::optional<Result> result;
    runInBackground([&](Progress& progress) { result.emplace(work(progress)); }, callback, threads);
    return std::move(*result);
}

}  // namespace bandvox::python

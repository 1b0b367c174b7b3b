#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace bandvox {

/// Lends each running task a worker (work arrays, or an object that has some) of its own; there
/// come to be as many as there are tasks at a time.
template <typename Worker>
class WorkerPool {
  public:
    explicit WorkerPool(std::function<std::unique_ptr<Worker>()> make) : mMake(std::move(make)) {}

    std::unique_ptr<Worker> take() {
        {
            const std::lock_guard<std::mutex> lock(mMutex);
            if (!mIdle.empty()) {
                std::unique_ptr<Worker> worker = std::move(mIdle.back());
                mIdle.pop_back();
                return worker;
            }
        }
        return mMake();
    }

    void giveBack(std::unique_ptr<Worker> worker) {
        const std::lock_guard<std::mutex> lock(mMutex);
        mIdle.push_back(std::move(worker));
    }

    /// The workers that no task has, for adding up what they counted.
    const std::vector<std::unique_ptr<Worker>>& idle() const { return mIdle; }

  private:
    std::function<std::unique_ptr<Worker>()> mMake;
    std::mutex mMutex;
    std::vector<std::unique_ptr<Worker>> mIdle;
};

}  // namespace bandvox

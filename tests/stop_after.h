#pragma once

#include <bandvox/core/error.h>
#include <bandvox/core/progress.h>

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <limits>

namespace bandvox {

/// Counts how often work asks whether to stop, and tells it to after that many times.
class StopAfter final : public Progress {
  public:
    explicit StopAfter(int times = std::numeric_limits<int>::max()) : mLeft(times) {}

    bool interrupted() const override { return mAsked++ >= mLeft; }
    int asked() const { return mAsked; }

  private:
    int mLeft;
    mutable std::atomic<int> mAsked{0};
};

/// Expects work to ask `least` times at least whether to stop, and to stop in the middle.
inline void expectStopsMidway(int least, const std::function<void(Progress&)>& work) {
    StopAfter never;
    work(never);
    ASSERT_GE(never.asked(), least);
    StopAfter half(never.asked() / 2);
    try {
        work(half);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted) << error.what();
    }
}

}  // namespace bandvox

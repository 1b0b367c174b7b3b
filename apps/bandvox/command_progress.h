#pragma once

#include <bandvox/core/progress.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox::app {

/// A stage of the work that is over.
struct StageTime {
    std::string name;
    double seconds = 0;
    std::int64_t steps = 0;  ///< how often it advanced
};

/// Shows on the terminal how far the work is, passes interrupts on to the library, and keeps the
/// time of every stage.
class CommandProgress final : public Progress {
  public:
    /// `visible`: draw on the standard error.
    explicit CommandProgress(bool visible) : mVisible(visible) {}

    void begin(std::string_view stage, std::int64_t steps) override;
    void advance(std::int64_t steps) override;
    void end() override;
    bool interrupted() const override;

    /// Takes the line away, so that something else can be printed.
    void erase();

    /// The stages that are over, in the order in which they first ended; those of one name are
    /// added up.
    const std::vector<StageTime>& stages() const { return mStages; }

  private:
    using Clock = std::chrono::steady_clock;

    struct Running {
        std::string name;
        std::int64_t steps = 0;      // expected; 0 if not known
        std::int64_t outerDone = 0;  // steps done of the stage around it
        Clock::time_point start;
    };

    void draw(Clock::time_point now);
    void eraseLocked();

    const bool mVisible;
    std::mutex mMutex;  // guards all that is not atomic
    std::vector<Running> mRunning;
    std::vector<StageTime> mStages;
    bool mLineShown = false;
    std::atomic<std::int64_t> mDone{0};    // steps of the innermost stage
    std::atomic<Clock::rep> mNextDraw{0};  // not before this time
};

}  // namespace bandvox::app

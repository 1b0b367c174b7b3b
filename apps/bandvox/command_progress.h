#pragma once

#include "progress_estimate.h"

#include <bandvox/core/progress.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bandvox::app {

/// A stage of the work that is over.
struct StageTime {
    std::string name;
    double seconds = 0;
    std::int64_t steps = 0;  ///< how often it advanced
};

/// How progress is shown on the standard error.
enum class ProgressDisplay {
    None,
    Bar,    ///< of the stage, on one line of a terminal that is drawn again and again
    Lines,  ///< "Progress: 42%" of the whole command, for programs that read along
};

/// Shows how far the work is, passes interrupts on to the library, and keeps the time of every
/// stage.
class CommandProgress final : public Progress {
  public:
    explicit CommandProgress(ProgressDisplay display) : mDisplay(display) {}

    /// The stages that the command is expected to go through; those of each part of it, if there
    /// are several.
    void expect(const std::vector<ExpectedStage>& stages);
    /// Part `index` of `count` of the command begins.
    void beginPart(std::size_t index, std::size_t count);
    /// The command has succeeded: what it was to do is done to a hundred percent.
    void showDone();

    void begin(std::string_view stage, std::int64_t steps) override;
    void advance(std::int64_t steps) override;
    void end() override;
    bool interrupted() const override;

    /// Takes the line away, so that something else can be printed.
    void erase();

    /// The stages that are over, in the order in which they first ended; those of one name are
    /// added up.
    const std::vector<StageTime>& stages() const { return mStages; }
    /// The same, and forgets them.
    std::vector<StageTime> takeStages() { return std::exchange(mStages, {}); }

  private:
    using Clock = std::chrono::steady_clock;

    struct Running {
        std::string name;
        std::int64_t steps = 0;      // expected; 0 if not known
        std::int64_t outerDone = 0;  // steps done of the stage around it
        Clock::time_point start;
    };

    void show(Clock::time_point now);
    void drawBar(const Running& running, Clock::time_point now);
    void printPercent(Clock::time_point now);
    void printLine(int percent);
    void eraseLocked();

    const ProgressDisplay mDisplay;
    std::mutex mMutex;  // guards all that is not atomic
    std::vector<Running> mRunning;
    std::vector<StageTime> mStages;
    bool mLineShown = false;
    ProgressEstimate mEstimate;
    std::vector<ExpectedStage> mExpected;
    std::size_t mPart = 0, mParts = 1;
    int mPercent = -1;                     // that was printed last
    Clock::time_point mNextPercent{};      // not before this time
    std::atomic<std::int64_t> mDone{0};    // steps of the innermost stage
    std::atomic<Clock::rep> mNextDraw{0};  // not before this time
};

}  // namespace bandvox::app

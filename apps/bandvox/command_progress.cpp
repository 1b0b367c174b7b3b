#include "command_progress.h"

#include "interrupt.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace bandvox::app {
namespace {

constexpr std::chrono::milliseconds kDrawInterval{100};
constexpr int kBarWidth = 30;
// Who reads lines wants to know of a change soon, and not to be kept busy by them.
constexpr std::chrono::milliseconds kPrintInterval{250};
constexpr int kLastPercent = 99;  // before all is done
constexpr std::size_t kNarrowestLine = 20;

std::size_t terminalWidth() {
    winsize size = {};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return std::max<std::size_t>(kNarrowestLine, size.ws_col);
}

}  // namespace

void CommandProgress::begin(std::string_view stage, std::int64_t steps) {
    const std::scoped_lock lock(mMutex);
    mRunning.push_back({std::string(stage), steps, mDone.exchange(0), Clock::now()});
    mEstimate.begin(stage);
    show(mRunning.back().start);
}

void CommandProgress::advance(std::int64_t steps) {
    mDone.fetch_add(steps, std::memory_order_relaxed);
    if (mDisplay == ProgressDisplay::None) return;
    const Clock::time_point now = Clock::now();
    if (now.time_since_epoch().count() < mNextDraw.load(std::memory_order_relaxed)) return;
    // Whoever finds somebody else drawing has work to do.
    const std::unique_lock lock(mMutex, std::try_to_lock);
    if (lock.owns_lock()) show(now);
}

void CommandProgress::end() {
    const std::scoped_lock lock(mMutex);
    const Running& running = mRunning.back();
    const std::chrono::duration<double> elapsed = Clock::now() - running.start;
    const std::int64_t done = mDone.exchange(running.outerDone);
    const auto known = std::find_if(mStages.begin(), mStages.end(), [&](const StageTime& stage) {
        return stage.name == running.name;
    });
    if (known == mStages.end()) {
        mStages.push_back({running.name, elapsed.count(), done});
    } else {
        known->seconds += elapsed.count();
        known->steps += done;
    }
    mRunning.pop_back();
    mEstimate.end();
    eraseLocked();
}

bool CommandProgress::interrupted() const {
    return interruptSignal() != 0;
}

void CommandProgress::erase() {
    const std::scoped_lock lock(mMutex);
    eraseLocked();
}

void CommandProgress::eraseLocked() {
    if (!mLineShown) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    mLineShown = false;
}

void CommandProgress::show(Clock::time_point now) {
    if (mRunning.empty() || mDisplay == ProgressDisplay::None) return;
    mNextDraw.store((now + kDrawInterval).time_since_epoch().count(), std::memory_order_relaxed);
    if (mDisplay == ProgressDisplay::Bar) {
        drawBar(mRunning.back(), now);
    } else {
        printPercent(now);
    }
}

void CommandProgress::drawBar(const Running& running, Clock::time_point now) {
    std::string line = running.name;
    if (running.steps > 0) {
        const std::int64_t done = std::clamp<std::int64_t>(mDone.load(), 0, running.steps);
        const double part = static_cast<double>(done) / static_cast<double>(running.steps);
        const int filled = static_cast<int>(part * kBarWidth);
        line += " [" + std::string(static_cast<std::size_t>(filled), '#') +
                std::string(static_cast<std::size_t>(kBarWidth - filled), '.') + "] " +
                std::to_string(static_cast<int>(part * 100)) + " %";
    } else {
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - running.start);
        line += " ... " + std::to_string(seconds.count()) + " s";
    }
    // A line that wraps could not be erased.
    line.resize(std::min(line.size(), terminalWidth() - 1));
    std::fprintf(stderr, "\r%s\033[K", line.c_str());
    std::fflush(stderr);
    mLineShown = true;
}

void CommandProgress::printPercent(Clock::time_point now) {
    if (now < mNextPercent) return;
    double part = 0;
    if (const auto open = mEstimate.openStage()) {
        // What an outer stage has done is kept by the one within it.
        const std::int64_t done =
            *open + 1 < mRunning.size() ? mRunning[*open + 1].outerDone : mDone.load();
        const std::int64_t steps = mRunning[*open].steps;
        if (steps > 0) part = static_cast<double>(done) / static_cast<double>(steps);
    }
    const double whole =
        (static_cast<double>(mPart) + mEstimate.at(part)) / static_cast<double>(mParts);
    const int percent = std::min(static_cast<int>(100 * whole), kLastPercent);
    if (percent <= mPercent) return;
    mNextPercent = now + kPrintInterval;
    printLine(percent);
}

void CommandProgress::printLine(int percent) {
    mPercent = percent;
    std::fprintf(stderr, "Progress: %d%%\n", percent);
}

void CommandProgress::expect(const std::vector<ExpectedStage>& stages) {
    const std::scoped_lock lock(mMutex);
    mExpected = stages;
    mEstimate.expect(mExpected);
}

void CommandProgress::beginPart(std::size_t index, std::size_t count) {
    const std::scoped_lock lock(mMutex);
    mPart = index;
    mParts = count;
    mEstimate.expect(mExpected);
}

void CommandProgress::showDone() {
    const std::scoped_lock lock(mMutex);
    if (mDisplay == ProgressDisplay::Lines && mPercent < 100) printLine(100);
}

}  // namespace bandvox::app

#pragma once

#include <chrono>

namespace bandvox {

/// Measures the time since it was made.
class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - mStart).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point mStart = Clock::now();
};

}  // namespace bandvox

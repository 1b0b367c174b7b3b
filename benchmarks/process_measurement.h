#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bandvox::benchmarks {

/// What one run of a variant took.
struct Measurement {
    double seconds = 0;    ///< wall clock, of the part that the variant times
    double megabytes = 0;  ///< the most memory resident in that part, beyond that before it
};

/// One way to do a work. It is called in a process of its own; what it does before `begin()` and
/// after `end()` does not count.
struct Variant {
    std::string name;
    std::function<void(const std::function<void()>& begin, const std::function<void()>& end)> run;
};

/// Runs the variants by turns, `rounds` times each, every time in a new process, and returns the
/// medians. This process must not have started threads. Throws std::runtime_error if one fails.
std::vector<Measurement> measure(const std::vector<Variant>& variants, int rounds);

}  // namespace bandvox::benchmarks

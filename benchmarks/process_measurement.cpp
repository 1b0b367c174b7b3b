#include "process_measurement.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace bandvox::benchmarks {

namespace {

// A line of /proc/self/status, in megabytes: VmRSS is resident now, VmHWM was at the most.
double statusMegabytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kibibytes = 0;
        if (word == key + ":" && status >> kibibytes) return kibibytes * 1024 / 1e6;
    }
    throw std::runtime_error("/proc/self/status has no " + key);
}

void forgetPeak() {
    std::ofstream("/proc/self/clear_refs") << 5;
}

Measurement runHere(const Variant& variant) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point start;
    double before = 0;
    Measurement result;
    variant.run(
        [&] {
            forgetPeak();
            before = statusMegabytes("VmRSS");
            start = Clock::now();
        },
        [&] {
            result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
            result.megabytes = statusMegabytes("VmHWM") - before;
        });
    return result;
}

Measurement runInChild(const Variant& variant) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        close(ends[0]);
        try {
            const Measurement result = runHere(variant);
            const auto written = write(ends[1], &result, sizeof result);
            _exit(written == static_cast<ssize_t>(sizeof result) ? 0 : 1);
        } catch (const std::exception& error) {
            std::cerr << variant.name << ": " << error.what() << std::endl;
            _exit(1);
        }
    }
    close(ends[1]);
    Measurement result;
    const auto received = read(ends[0], &result, sizeof result);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0 || received != static_cast<ssize_t>(sizeof result)) {
        throw std::runtime_error(variant.name + " failed");
    }
    return result;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

std::vector<Measurement> measure(const std::vector<Variant>& variants, int rounds) {
    std::vector<std::vector<Measurement>> runs(variants.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t v = 0; v < variants.size(); ++v) {
            runs[v].push_back(runInChild(variants[v]));
        }
    }
    std::vector<Measurement> medians;
    for (const std::vector<Measurement>& list : runs) {
        std::vector<double> seconds, megabytes;
        for (const Measurement& run : list) {
            seconds.push_back(run.seconds);
            megabytes.push_back(run.megabytes);
        }
        medians.push_back({median(seconds), median(megabytes)});
    }
    return medians;
}

}  // namespace bandvox::benchmarks

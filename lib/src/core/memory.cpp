#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

namespace bandvox {

namespace {

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

// The number in a file of one number, or kUnlimited if there is none ("max", no such file).
std::int64_t numberIn(const char* path) {
    std::ifstream file(path);
    std::int64_t value = 0;
    return file >> value ? value : kUnlimited;
}

std::int64_t availableInSystem() {
    std::ifstream file("/proc/meminfo");
    std::string key, unit;
    std::int64_t kibibytes = 0;
    while (file >> key >> kibibytes) {
        std::getline(file, unit);
        if (key == "MemAvailable:") return kibibytes * 1024;
    }
    return kUnlimited;
}

// What a control group (a container, a batch job) leaves; both versions of the interface.
std::int64_t availableInControlGroup(const char* limitFile, const char* usageFile) {
    const std::int64_t limit = numberIn(limitFile);
    const std::int64_t usage = numberIn(usageFile);
    if (limit == kUnlimited || usage == kUnlimited) return kUnlimited;
    return std::max<std::int64_t>(0, limit - usage);
}

// What the process's own limit on its address space leaves (ulimit -v).
std::int64_t availableInAddressSpace() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    std::ifstream file("/proc/self/statm");
    std::int64_t pages = 0;
    file >> pages;
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(limit.rlim_cur) - pages * 4096);
}

std::string inGigabytes(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, bytes < 1e12 ? "%.2f GB" : "%.3g GB", bytes * 1e-9);
    return text;
}

}  // namespace

std::int64_t availableMemory() {
    return std::min(
        {availableInSystem(),
         availableInControlGroup("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
         availableInControlGroup("/sys/fs/cgroup/memory/memory.limit_in_bytes",
                                 "/sys/fs/cgroup/memory/memory.usage_in_bytes"),
         availableInAddressSpace()});
}

std::int64_t peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

void requireMemory(double bytes, const char* what) {
    const double available = static_cast<double>(availableMemory());
    if (bytes > available) {
        throw Error(ErrorKind::Memory, std::string(what) + " would need about " +
                                           inGigabytes(bytes) + " of memory, and " +
                                           inGigabytes(available) + " is available");
    }
}

}  // namespace bandvox

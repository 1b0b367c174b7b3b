#include "core/control_group.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

namespace bandvox {

namespace {

std::int64_t availableInSystem() {
    std::ifstream file("/proc/meminfo");
    std::string key, unit;
    std::int64_t kibibytes = 0;
    while (file >> key >> kibibytes) {
        std::getline(file, unit);
        if (key == "MemAvailable:") return kibibytes * 1024;
    }
    return kUnlimitedMemory;
}

// What the process's own limit on its address space leaves (ulimit -v).
std::int64_t availableInAddressSpace() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return kUnlimitedMemory;
    std::ifstream file("/proc/self/statm");
    std::int64_t pages = 0;
    file >> pages;
    const std::int64_t taken = pages * sysconf(_SC_PAGESIZE);
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(limit.rlim_cur) - taken);
}

std::string inGigabytes(double bytes) {
    char text[32];
    const bool isOfMachine = bytes >= 1e8 && bytes < 1e12;
    std::snprintf(text, sizeof text, isOfMachine ? "%.2f GB" : "%.3g GB", bytes * 1e-9);
    return text;
}

}  // namespace

std::int64_t availableMemory() {
    return std::min({availableInSystem(), availableInControlGroups(), availableInAddressSpace()});
}

std::int64_t residentMemory() {
    std::ifstream file("/proc/self/statm");
    std::int64_t pages = 0, resident = 0;
    file >> pages >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

std::int64_t peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

void returnFreeMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
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

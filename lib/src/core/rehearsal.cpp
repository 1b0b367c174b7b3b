#include "core/rehearsal.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>

namespace bandvox {

namespace {

/// Bytes of addresses that the process has.
std::int64_t addressesInUse() {
    std::int64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

void setLimit(int resource, std::int64_t most) {
    const auto value = static_cast<rlim_t>(most);
    const rlimit limit{value, value};
    setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// In the copy: becomes one that harms nobody, works, and writes what went wrong to `out`.
[[noreturn]] void workAndEnd(const std::function<std::string()>& work,
                             const RehearsalLimits& limits, std::int64_t inUse, int out) {
    // It ends with the process that waits for it, and leaves the user's wishes to that.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGABRT, SIGSEGV}) {
        std::signal(signal, SIG_DFL);
    }
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere >= 0) {
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
            dup2(nowhere, stream);
        }
    }
    setLimit(RLIMIT_CORE, 0);
    setLimit(RLIMIT_CPU, limits.seconds);
    if (limits.bytes > 0) setLimit(RLIMIT_AS, inUse + limits.bytes);
    std::string wrong;
    try {
        wrong = work();
    } catch (const std::bad_alloc&) {
        wrong = "asked for more memory than such a file can need";
    } catch (const std::exception& error) {
        wrong = error.what();
    }
    // More than a pipe holds could wait for a reader.
    const std::size_t size = std::min<std::size_t>(wrong.size(), 4000);
    const bool isWritten = write(out, wrong.data(), size) == static_cast<ssize_t>(size);
    _exit(isWritten ? 0 : 1);
}

/// Waits until the other end of the pipe is closed, which the copy's end does at the latest.
std::string readAll(int in, pid_t copy, Progress& progress) {
    constexpr int kMilliseconds = 20;
    std::string all;
    std::array<char, 4096> part;
    while (true) {
        pollfd wanted{in, POLLIN, 0};
        if (poll(&wanted, 1, kMilliseconds) > 0) {
            const ssize_t size = read(in, part.data(), part.size());
            if (size > 0) all.append(part.data(), static_cast<std::size_t>(size));
            if (size == 0 || (size < 0 && errno != EINTR)) return all;
        }
        if (progress.interrupted()) kill(copy, SIGKILL);
    }
}

}  // namespace

std::string rehearse(const std::function<std::string()>& work, const RehearsalLimits& limits,
                     Progress& progress) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return {};
    const std::int64_t inUse = addressesInUse();
    const pid_t copy = fork();
    if (copy == 0) {
        close(ends[0]);
        workAndEnd(work, limits, inUse, ends[1]);
    }
    close(ends[1]);
    std::string wrong;
    int status = 0;
    if (copy > 0) {
        wrong = readAll(ends[0], copy, progress);
        while (waitpid(copy, &status, 0) < 0 && errno == EINTR) {
        }
    }
    close(ends[0]);
    progress.throwIfInterrupted();
    if (!WIFSIGNALED(status)) return wrong;
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL) {
        return "took more than " + std::to_string(limits.seconds) + " seconds";
    }
    return "crashed with signal " + std::to_string(signal);
}

}  // namespace bandvox
